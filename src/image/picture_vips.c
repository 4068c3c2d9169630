#include <pthread.h>
#include <stdbool.h>
#include <string.h>

#include "image/picture.h"
#include "image/vips_library.h"

/* Replaces *image by what an operation made of it; true on success. made is a pointer so that the operation may be
 * written as the last argument: in which order arguments are computed is the compiler's choice. */
static bool replace(VipsImage **image, VipsImage *const *made, int failed)
{
    if (failed) return false;
    vips()->g_object_unref(*image);
    *image = *made;
    return true;
}

typedef int loader(const char *path, VipsImage **out, ...);

/* Each kind by its own: asked to find one, libvips shows what it does not know, such as a file cut short, to all that
 * it has, and CFITSIO, one of the libraries behind it, crashes now and then on what is not its own. */
static loader *loader_of(picture_kind kind)
{
    switch (kind) {
    case PICTURE_PNG:
        return vips()->pngload;
    case PICTURE_JPEG:
        return vips()->jpegload;
    case PICTURE_TIFF:
        return vips()->tiffload;
    case PICTURE_WEBP:
        return vips()->webpload;
    case PICTURE_HDR:
        return vips()->radload;
    case PICTURE_HEIC:
        return vips_load_heif() ? vips()->heifload : NULL;
    case PICTURE_EXR:
    case PICTURE_RAW:
    case PICTURE_UNKNOWN:
        break;
    }
    return NULL;
}

/* libvips divides a TIFF's colours by an alpha of 0 to 255, of floats, too, whose alpha is 0 to 1 (8.14). That is
 * undone by its inverse, whatever it took for the range, and then done by the range of floats. */
static bool divide_by_alpha(VipsImage **image, const char *path)
{
    VipsImage *made = NULL;
    if (vips()->image_get_format(*image) != VIPS_FORMAT_FLOAT || !picture_tiff_is_premultiplied(path)) return true;
    return replace(image, &made, vips()->premultiply(*image, &made, NULL)) &&
           replace(image, &made, vips()->unpremultiply(*image, &made, "max_alpha", 1.0, NULL));
}

static status open_picture(const char *path, picture_kind kind, VipsImage **out)
{
    VipsImage *image = NULL;
    loader *load = loader_of(kind);
    if (!load) return fail(ERROR_INPUT, "cannot read %s: the libvips installed here does not know its kind", path);
    status s = kind == PICTURE_HDR ? picture_check_hdr(path) : kind == PICTURE_TIFF ? picture_check_tiff(path) : OK;
    if (s != OK) return s;
    /* what is read in sequence is not kept for the next time, when the file may be another */
    if (load(path, &image, "fail_on", VIPS_FAIL_ON_TRUNCATED, "access", VIPS_ACCESS_SEQUENTIAL, NULL))
        return vips_refusal(ERROR_INPUT, "read", path);
    int width = vips()->image_get_width(image), height = vips()->image_get_height(image);
    s = picture_check_size(path, width, height);
    if (s == OK && kind == PICTURE_TIFF && !divide_by_alpha(&image, path)) s = vips_refusal(ERROR_INPUT, "read", path);
    if (s == OK)
        *out = image;
    else
        vips()->g_object_unref(image);
    return s;
}

/* From the codings of Radiance files and of 8-bit CIELAB to samples. */
static bool unpack(VipsImage **image)
{
    VipsImage *made = NULL;
    VipsCoding coding = vips()->image_get_coding(*image);
    if (coding == VIPS_CODING_RAD) return replace(image, &made, vips()->rad2float(*image, &made, NULL));
    if (coding != VIPS_CODING_LABQ) return true;
    return replace(image, &made, vips()->colourspace(*image, &made, VIPS_INTERPRETATION_LAB, NULL));
}

/* Decodes all pixels into memory and turns the picture upright. */
static bool load_upright(VipsImage **image)
{
    VipsImage *made = vips()->image_copy_memory(*image);
    if (!replace(image, &made, made == NULL) || !unpack(image)) return false;
    if (vips()->image_get_orientation(*image) <= 1) return true;
    return replace(image, &made, vips()->autorot(*image, &made, NULL));
}

static bool split_alpha(VipsImage **image, VipsImage **alpha)
{
    int bands = vips()->image_get_bands(*image);
    if (!vips()->image_hasalpha(*image)) return true;
    VipsImage *made = NULL;
    if (vips()->extract_band(*image, alpha, bands - 1, NULL)) return false;
    return replace(image, &made, vips()->extract_band(*image, &made, 0, "n", bands - 1, NULL));
}

/* Whether the samples already mean sRGB, grey or linear light, so that our own tables decode them. */
static bool is_plain(VipsInterpretation i)
{
    return i == VIPS_INTERPRETATION_MULTIBAND || i == VIPS_INTERPRETATION_B_W || i == VIPS_INTERPRETATION_sRGB ||
           i == VIPS_INTERPRETATION_RGB || i == VIPS_INTERPRETATION_RGB16 || i == VIPS_INTERPRETATION_GREY16 ||
           i == VIPS_INTERPRETATION_scRGB || i == VIPS_INTERPRETATION_HISTOGRAM;
}

/* Brings other colour spaces to sRGB: by the embedded profile, at 16 bits so that dark codes keep their steps, or by
 * what the file says it is. A damaged profile is ignored, as viewers do. */
static bool convert_space(VipsImage **image)
{
    VipsImage *made = NULL;
    bool integers = vips()->band_format_isint(vips()->image_get_format(*image));
    if (integers && vips()->image_get_typeof(*image, VIPS_META_ICC_NAME)) {
        int failed = vips()->icc_transform(*image, &made, "srgb", "embedded", TRUE, "depth", 16, "intent",
                                           VIPS_INTENT_RELATIVE, NULL);
        VipsImage *pixels = failed ? NULL : vips()->image_copy_memory(made);
        if (made) vips()->g_object_unref(made);
        if (replace(image, &pixels, pixels == NULL)) return true;
        vips()->error_clear();
    }
    if (is_plain(vips()->image_get_interpretation(*image))) return true;
    return replace(image, &made, vips()->colourspace(*image, &made, VIPS_INTERPRETATION_sRGB, NULL));
}

/* What libvips has ready of an image of floats; it hands out whole rows. */
static int put_floats(VipsRegion *from, VipsRect *area, void *context)
{
    const img *out = context;
    size_t bands = (size_t)vips()->image_get_bands(from->im), channels = (size_t)out->channels;
    for (int y = area->top; y < area->top + area->height; y++) {
        const void *first = from->data + (ptrdiff_t)(y - from->valid.top) * VIPS_REGION_LSKIP(from);
        const float *row = first;
        float *to = img_at(out, 0, y);
        for (size_t x = 0; x < (size_t)area->width; x++)
            memcpy(to + x * channels, row + x * bands, channels * sizeof *to);
    }
    return 0;
}

static status take_codes(VipsImage *image, const char *path, bool decode, img *out)
{
    size_t size = 0;
    void *samples = vips()->image_write_to_memory(image, &size);
    if (!samples) return vips_refusal(ERROR_INPUT, "read", path);
    bool wide = vips()->image_get_format(image) == VIPS_FORMAT_USHORT;
    picture_take_codes(samples, wide, vips()->image_get_bands(image), 0, decode, out);
    vips()->g_free(samples);
    return OK;
}

/* Floats as they come, for of the largest pictures, of gigabytes, there should be one copy. */
static status take_floats(VipsImage *image, const char *path, img *out)
{
    VipsImage *floats = NULL;
    if (vips()->cast(image, &floats, VIPS_FORMAT_FLOAT, NULL)) return vips_refusal(ERROR_INPUT, "read", path);
    status s = vips()->sink_disc(floats, put_floats, out) ? vips_refusal(ERROR_INPUT, "read", path) : OK;
    vips()->g_object_unref(floats);
    return s;
}

/* Takes the pixels out of libvips; decode: integers are sRGB. */
static status take(VipsImage *image, const char *path, bool decode, img *out)
{
    VipsBandFormat format = vips()->image_get_format(image);
    bool codes = format == VIPS_FORMAT_UCHAR || format == VIPS_FORMAT_USHORT;
    if (!codes && format != VIPS_FORMAT_FLOAT && format != VIPS_FORMAT_DOUBLE)
        return fail(ERROR_INPUT, "cannot read %s: its samples are of type %s; 8 or 16 bits or floats are read", path,
                    vips()->enum_nick(vips()->band_format_get_type(), format));
    int width = vips()->image_get_width(image), height = vips()->image_get_height(image);
    status s = img_new(out, width, height, vips()->image_get_bands(image) < 3 ? 1 : 3);
    if (s != OK) return s;
    return codes ? take_codes(image, path, decode, out) : take_floats(image, path, out);
}

static status decode_open(VipsImage **image, VipsImage **opacity, const char *path, picture_colour how, img *color,
                          img *alpha)
{
    bool decode = how == PICTURE_LINEARIZE;
    if (!load_upright(image) || !split_alpha(image, opacity) || (decode && !convert_space(image)))
        return vips_refusal(ERROR_INPUT, "read", path);
    VipsInterpretation space = vips()->image_get_interpretation(*image);
    if (!decode && !is_plain(space))
        return fail(ERROR_INPUT, "cannot read %s: its samples are %s, not light; save it in grey or RGB", path,
                    vips()->enum_nick(vips()->interpretation_get_type(), space));
    status s = take(*image, path, decode, color);
    if (s == OK && alpha && *opacity) s = take(*opacity, path, false, alpha);
    return s;
}

/* What is asked of a picture: its pixels, or its head alone. */
typedef struct request {
    const char *path;
    picture_kind kind;
    picture_colour how;
    img *color, *alpha;
    picture_head *head;
} request;

static status decode(const request *r)
{
    VipsImage *opened = NULL, *image = NULL, *opacity = NULL;
    status s = open_picture(r->path, r->kind, &opened);
    if (s != OK) return s;
    image = (vips()->g_object_ref)(opened); /* GLib has a macro of that name */
    s = decode_open(&image, &opacity, r->path, r->how, r->color, r->alpha);
    vips()->g_object_unref(image);
    if (opacity) vips()->g_object_unref(opacity);
    /* last: with it goes the colour profile of a HEIF, which no copy keeps alive */
    vips()->g_object_unref(opened);
    return s;
}

static status look(const request *r)
{
    VipsImage *image = NULL;
    status s = open_picture(r->path, r->kind, &image);
    if (s != OK) return s;
    VipsBandFormat format = vips()->image_get_format(image);
    *r->head = (picture_head){.width = vips()->image_get_width(image),
                              .height = vips()->image_get_height(image),
                              .bits = format == VIPS_FORMAT_UCHAR    ? 8
                                      : format == VIPS_FORMAT_USHORT ? 16
                                                                     : 32,
                              .profile = vips()->image_get_typeof(image, VIPS_META_ICC_NAME) != 0};
    vips()->g_object_unref(image);
    return OK;
}

/* libvips keeps its words for all threads in one place. Pictures are read side by side all the same; one that is
 * refused is read again while no other is, so that the words are about it. */
static status read_side_by_side(status (*work)(const request *r), const request *r)
{
    static pthread_rwlock_t reading = PTHREAD_RWLOCK_INITIALIZER;
    status s = vips_begin();
    if (s != OK) return s;
    pthread_rwlock_rdlock(&reading);
    s = work(r);
    pthread_rwlock_unlock(&reading);
    if (s == OK) return OK;
    img_free(r->color);
    img_free(r->alpha);
    pthread_rwlock_wrlock(&reading);
    vips()->error_clear();
    s = work(r);
    pthread_rwlock_unlock(&reading);
    return s;
}

status picture_decode(const char *path, picture_kind kind, picture_colour how, img *color, img *alpha)
{
    return read_side_by_side(decode, &(request){path, kind, how, color, alpha, NULL});
}

status picture_look(const char *path, picture_kind kind, picture_head *head)
{
    return read_side_by_side(look, &(request){.path = path, .kind = kind, .head = head});
}

static status turn(VipsImage *image, img *out)
{
    VipsImage *made = NULL;
    if (vips()->autorot(image, &made, NULL)) return vips_refusal(ERROR_INPUT, "turn", "a picture");
    size_t size = 0;
    void *samples = vips()->image_write_to_memory(made, &size);
    int width = vips()->image_get_width(made), height = vips()->image_get_height(made);
    vips()->g_object_unref(made);
    if (!samples) return vips_refusal(ERROR_INPUT, "turn", "a picture");
    status s = img_new(out, width, height, out->channels);
    if (s == OK) memcpy(out->data, samples, size);
    vips()->g_free(samples);
    return s;
}

status picture_turn(img *image, int orientation)
{
    if (orientation == 1) return OK;
    status s = vips_begin();
    if (s != OK) return s;
    size_t size = img_value_count(image) * sizeof *image->data;
    VipsImage *lying = vips()->image_new_from_memory(image->data, size, image->width, image->height, image->channels,
                                                     VIPS_FORMAT_FLOAT);
    if (!lying) return vips_refusal(ERROR_INPUT, "turn", "a picture");
    vips()->image_set_int(lying, VIPS_META_ORIENTATION, orientation);
    img upright = {.channels = image->channels};
    s = turn(lying, &upright);
    vips()->g_object_unref(lying);
    if (s != OK) return s;
    img_free(image);
    *image = upright;
    return OK;
}
