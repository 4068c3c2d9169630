/* SPDX-License-Identifier: MIT */
#include <pthread.h>
#include <stdbool.h>
#include <string.h>

#include "image/formats/picture_rows.h"
#include "image/metadata/box_file.h"
#include "image/metadata/exif.h"
#include "image/metadata/profile.h"
#include "image/vips_library.h"
#include "image/vips_start.h"

typedef int loader(const char *path, VipsImage **out, ...);

/* Returns the loader for a kind. libvips is not asked to find one: it offers an unknown file, such as a truncated one,
 * to every library it has, and CFITSIO sometimes crashes on files that are not its own. */
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
    case PICTURE_GIF:
        return vips()->gifload;
    case PICTURE_HEIC:
        return vips_load_heif() ? vips()->heifload : NULL;
    case PICTURE_EXR:
    case PICTURE_RAW:
    case PICTURE_BMP:
    case PICTURE_PNM:
    case PICTURE_TGA:
    case PICTURE_OTHER:
    case PICTURE_UNKNOWN:
        break;
    }
    return NULL;
}

/* Divides a float TIFF's colours by alpha. libvips (8.14) assumes an alpha of 0 to 255 for floats, too, where it is 0
 * to 1: its division is undone by its inverse and done again with the range of floats. */
static bool divide_by_alpha(VipsImage **image, const picture_tiff_page *page)
{
    VipsImage *made = NULL;
    if (vips()->image_get_format(*image) != VIPS_FORMAT_FLOAT || !page->premultiplied) return true;
    return vips_pass_on(image, &made, vips()->premultiply(*image, &made, NULL)) &&
           vips_pass_on(image, &made, vips()->unpremultiply(*image, &made, "max_alpha", 1.0, NULL));
}

/* Reads the code points (ITU-T H.273) that a HEIC or AVIF states. Its codes are always encoded for screens, whatever
 * their number of bits. */
static status find_heif_light(const char *path, picture_light *light)
{
    int n[3];
    byte_source file;
    bool stated = byte_source_open(&file, path) && box_read_colour(&file, n);
    byte_source_close(&file);
    *light = (picture_light){.said = true};
    if (!stated || picture_light_of_cicp(n[0], n[1], light)) {
        light->said = true;
        return OK;
    }
    return fail(MERLIN_BAD_INPUT,
                "cannot read %s: it states primaries %d and transfer %d, which are not known here; save it as sRGB",
                path, n[0], n[1]);
}

/* Finds what a file states about its codes, beside a profile. */
static status find_light(const char *path, picture_kind kind, picture_tiff_page *page, picture_light *light)
{
    exif_facts facts;
    *light = (picture_light){.said = false};
    if (kind == PICTURE_HDR) return picture_check_hdr(path);
    if (kind == PICTURE_HEIC) return find_heif_light(path, light);
    if (kind == PICTURE_TIFF) {
        status s = picture_check_tiff(path, page);
        *light = page->light;
        return s;
    }
    status s = exif_read(path, &facts);
    if (facts.colours == EXIF_COLOURS_ADOBE) *light = picture_light_of_adobe_rgb();
    return s;
}

/* Opens a picture; light: what the file states about its codes, beside a profile. */
static status open_picture(const char *path, picture_kind kind, VipsImage **out, picture_light *light)
{
    VipsImage *image = NULL;
    picture_tiff_page page = {.number = 0};
    loader *load = loader_of(kind);
    if (!load) return fail(MERLIN_BAD_INPUT, "cannot read %s: the libvips installed here does not know its kind", path);
    status s = find_light(path, kind, &page, light);
    if (s != OK) return s;
    /* sequential pictures are not cached: next time the file may be another */
    int failed = kind == PICTURE_TIFF
                     ? load(path, &image, "fail_on", VIPS_FAIL_ON_TRUNCATED, "access", VIPS_ACCESS_SEQUENTIAL, "page",
                            page.number, NULL)
                     : load(path, &image, "fail_on", VIPS_FAIL_ON_TRUNCATED, "access", VIPS_ACCESS_SEQUENTIAL, NULL);
    if (failed && (s = picture_check_cut(path, kind)) == OK) s = vips_refusal(MERLIN_BAD_INPUT, "read", path);
    if (failed) return s;
    s = picture_check_size(path, vips()->image_get_width(image), vips()->image_get_height(image));
    if (s == OK) s = picture_check_held(path, kind, vips()->image_get_width(image), vips()->image_get_height(image));
    if (s == OK && !divide_by_alpha(&image, &page)) s = vips_refusal(MERLIN_BAD_INPUT, "read", path);
    if (s == OK)
        *out = image;
    else
        vips()->g_object_unref(image);
    return s;
}

/* Converts the codings of Radiance files and of 8-bit CIELAB to samples. */
static bool unpack(VipsImage **image)
{
    VipsImage *made = NULL;
    VipsCoding coding = vips()->image_get_coding(*image);
    if (coding == VIPS_CODING_RAD) return vips_pass_on(image, &made, vips()->rad2float(*image, &made, NULL));
    if (coding != VIPS_CODING_LABQ) return true;
    return vips_pass_on(image, &made, vips()->colourspace(*image, &made, VIPS_INTERPRETATION_LAB, NULL));
}

/* Tells whether the samples are already sRGB, grey or linear light, so that our own tables decode them. */
static bool is_plain(VipsInterpretation i)
{
    return i == VIPS_INTERPRETATION_MULTIBAND || i == VIPS_INTERPRETATION_B_W || i == VIPS_INTERPRETATION_sRGB ||
           i == VIPS_INTERPRETATION_RGB || i == VIPS_INTERPRETATION_RGB16 || i == VIPS_INTERPRETATION_GREY16 ||
           i == VIPS_INTERPRETATION_scRGB || i == VIPS_INTERPRETATION_HISTOGRAM;
}

/* What is requested of a picture: its pixels, or its header alone. */
typedef struct request {
    const char *path;
    picture_kind kind;
    picture_colour how;
    img *color, *alpha;
    picture_head *head;
    bool by_profile;
    bool *profiled; /* set to true if a profile was used */
} request;

/* Tells whether a profile defines the codes and is to be applied. */
static bool has_profile(VipsImage *image, const request *r)
{
    return r->by_profile && vips()->band_format_isint(vips()->image_get_format(image)) && profile_is_fit(image);
}

/* Converts other colour spaces to sRGB: by the embedded profile, at 16 bits to keep the steps of dark codes, or by the
 * space the file states. */
static bool convert_space(VipsImage **image, const request *r)
{
    VipsImage *made = NULL;
    if (has_profile(*image, r)) {
        *r->profiled = true;
        return vips_pass_on(image, &made, !profile_apply(*image, &made));
    }
    if (is_plain(vips()->image_get_interpretation(*image))) return true;
    return vips_pass_on(image, &made, vips()->colourspace(*image, &made, VIPS_INTERPRETATION_sRGB, NULL));
}

/* Tells whether a picture is converted to sRGB. What is only shown keeps its codes where they are grey or RGB. */
static bool is_converted(VipsImage *image, const request *r)
{
    if (r->how == PICTURE_AS_SHOWN) return !is_plain(vips()->image_get_interpretation(image));
    return r->how == PICTURE_LINEARIZE;
}

/* Passes on the rows that libvips has ready: whole rows, from the top. */
static int put_rows(VipsRegion *from, VipsRect *area, void *context)
{
    for (int y = area->top; y < area->top + area->height; y++)
        picture_rows_put(context, y, from->data + (ptrdiff_t)(y - from->valid.top) * VIPS_REGION_LSKIP(from));
    return 0;
}

static status find_sample(VipsImage *image, const char *path, picture_sample *sample)
{
    VipsBandFormat format = vips()->image_get_format(image);
    *sample = format == VIPS_FORMAT_UCHAR    ? PICTURE_UINT8
              : format == VIPS_FORMAT_USHORT ? PICTURE_UINT16
                                             : PICTURE_FLOAT;
    if (*sample != PICTURE_FLOAT || format == VIPS_FORMAT_FLOAT || format == VIPS_FORMAT_DOUBLE) return OK;
    return fail(MERLIN_BAD_INPUT, "cannot read %s: its samples are of type %s; 8 or 16 bits or floats are read", path,
                vips()->enum_nick(vips()->band_format_get_type(), format));
}

static status find_layout(VipsImage *image, const char *path, picture_layout *out)
{
    *out = (picture_layout){.width = vips()->image_get_width(image),
                            .height = vips()->image_get_height(image),
                            .bands = vips()->image_get_bands(image),
                            .alpha = vips()->image_hasalpha(image),
                            .orientation = vips()->image_get_orientation(image)};
    return find_sample(image, path, &out->sample);
}

static status take_rows(VipsImage **image, const char *path, const picture_layout *layout, picture_colour how,
                        img *color, img *alpha)
{
    VipsImage *made = NULL;
    picture_rows *rows;
    if (layout->sample == PICTURE_FLOAT &&
        !vips_pass_on(image, &made, vips()->cast(*image, &made, VIPS_FORMAT_FLOAT, NULL)))
        return vips_refusal(MERLIN_BAD_INPUT, "read", path);
    status s = picture_rows_new(layout, how, color, alpha, &rows);
    if (s == OK && vips()->sink_disc(*image, put_rows, rows)) s = vips_refusal(MERLIN_BAD_INPUT, "read", path);
    picture_rows_free(rows);
    return s;
}

/* Returns the orientation, also from a PNG's text chunks, where libvips does not look. */
static status find_orientation(const char *path, int *orientation)
{
    exif_facts facts;
    status s = exif_read(path, &facts);
    *orientation = facts.orientation;
    return s;
}

/* Decodes an open picture. light: of the stored codes, from which other spaces and profiles are converted to sRGB. */
static status decode_open(VipsImage **image, const request *r, picture_light light)
{
    const bool decode = r->how == PICTURE_LINEARIZE;
    const bool floats = !vips()->band_format_isint(vips()->image_get_format(*image));
    picture_layout layout;
    if (has_profile(*image, r) || !is_plain(vips()->image_get_interpretation(*image)))
        light = (picture_light){.said = false};
    if (decode && floats && vips()->image_get_typeof(*image, VIPS_META_ICC_NAME)) {
        status known = profile_light(*image, r->path, &light);
        if (known != OK) return known;
    }
    if (!unpack(image) || (is_converted(*image, r) && !convert_space(image, r)))
        return vips_refusal(MERLIN_BAD_INPUT, "read", r->path);
    VipsInterpretation space = vips()->image_get_interpretation(*image);
    if (!decode && !is_plain(space))
        return fail(MERLIN_BAD_INPUT, "cannot read %s: its samples are %s, not light; save it in grey or RGB", r->path,
                    vips()->enum_nick(vips()->interpretation_get_type(), space));
    status s = find_layout(*image, r->path, &layout);
    if (s == OK && r->kind == PICTURE_PNG) s = find_orientation(r->path, &layout.orientation);
    layout.light = light;
    layout.coded = floats;
    return s == OK ? take_rows(image, r->path, &layout, r->how, r->color, r->alpha) : s;
}

static status decode(const request *r)
{
    VipsImage *opened = NULL, *image = NULL;
    picture_light light;
    status s = open_picture(r->path, r->kind, &opened, &light);
    if (s != OK) return s;
    image = (vips()->g_object_ref)(opened); /* in brackets because GLib has a macro of that name */
    s = decode_open(&image, r, light);
    vips()->g_object_unref(image);
    /* freed last, as it holds the colour profile of a HEIF, which no copy keeps alive */
    vips()->g_object_unref(opened);
    return s;
}

static status look(const request *r)
{
    VipsImage *image = NULL;
    picture_light light;
    status s = open_picture(r->path, r->kind, &image, &light);
    if (s != OK) return s;
    VipsBandFormat format = vips()->image_get_format(image);
    *r->head = (picture_head){
        .width = vips()->image_get_width(image),
        .height = vips()->image_get_height(image),
        .bits = format == VIPS_FORMAT_UCHAR    ? 8
                : format == VIPS_FORMAT_USHORT ? 16
                                               : 32,
        .frames = r->kind == PICTURE_GIF || r->kind == PICTURE_WEBP ? vips()->image_get_n_pages(image) : 1,
        .profile = vips()->image_get_typeof(image, VIPS_META_ICC_NAME) != 0,
        .light = light};
    vips()->g_object_unref(image);
    return OK;
}

/* Runs `work` in parallel with others. libvips keeps one error message for all threads, so that a picture that is
 * refused is read again alone, to get the message that belongs to it. */
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

/* Ignores a damaged profile, as viewers do. */
status picture_decode(const char *path, picture_kind kind, picture_colour how, img *color, img *alpha)
{
    bool profiled = false;
    request r = {path, kind, how, color, alpha, NULL, true, &profiled};
    status s = read_side_by_side(decode, &r);
    if (s == OK || !profiled) return s;
    r.by_profile = false;
    return read_side_by_side(decode, &r);
}

status picture_look(const char *path, picture_kind kind, picture_head *head)
{
    return read_side_by_side(look, &(request){.path = path, .kind = kind, .head = head});
}
