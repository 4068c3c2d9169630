#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <vips/vips.h>

#include "image/color.h"
#include "image/picture.h"
#include "image/read.h"
#include "image/start.h"

/* Replaces *image by what an operation made of it; true on success. */
static bool replace(VipsImage **image, VipsImage *made, int failed)
{
    if (failed) return false;
    g_object_unref(*image);
    *image = made;
    return true;
}

/* The formats this project promises; libvips would also try vector graphics, documents and whatever ImageMagick takes.
 */
static bool is_photograph(const char *loader)
{
    static const char *const kinds[] = {"Png", "Jpeg", "Tiff", "Webp", "Heif", "Rad", "Spng"};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strstr(loader, kinds[i])) return true;
    return false;
}

static status open_picture(const char *path, VipsImage **out)
{
    const char *loader = vips_foreign_find_load(path);
    if (!loader && vips_load_heif()) loader = vips_foreign_find_load(path);
    if (!loader || !is_photograph(loader)) {
        vips_error_clear();
        return fail(ERROR_INPUT,
                    "cannot read %s: it is not a picture of a kind known here (PNG, JPEG, TIFF, WebP, HEIC, EXR, HDR)",
                    path);
    }
    VipsImage *image = vips_image_new_from_file(path, "fail_on", VIPS_FAIL_ON_TRUNCATED, NULL);
    if (!image) return vips_refusal(ERROR_INPUT, "read", path);
    int width = vips_image_get_width(image), height = vips_image_get_height(image);
    if (width > IMAGE_MAX_SIDE || height > IMAGE_MAX_SIDE) {
        g_object_unref(image);
        return fail(ERROR_INPUT, "cannot read %s: it is %d x %d pixels, more than %d a side; make it smaller first",
                    path, width, height, IMAGE_MAX_SIDE);
    }
    *out = image;
    return OK;
}

/* Decodes all pixels into memory, unpacks Radiance's coding and turns the picture upright. */
static bool load_upright(VipsImage **image)
{
    VipsImage *made = vips_image_copy_memory(*image);
    if (!replace(image, made, made == NULL)) return false;
    if (vips_image_get_coding(*image) == VIPS_CODING_RAD && !replace(image, made, vips_rad2float(*image, &made, NULL)))
        return false;
    if (vips_image_get_orientation(*image) <= 1) return true;
    return replace(image, made, vips_autorot(*image, &made, NULL));
}

static bool split_alpha(VipsImage **image, VipsImage **alpha)
{
    int bands = vips_image_get_bands(*image);
    if (!vips_image_hasalpha(*image)) return true;
    VipsImage *made = NULL;
    if (vips_extract_band(*image, alpha, bands - 1, NULL)) return false;
    return replace(image, made, vips_extract_band(*image, &made, 0, "n", bands - 1, NULL));
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
    bool integers = vips_band_format_isint(vips_image_get_format(*image));
    if (integers && vips_image_get_typeof(*image, VIPS_META_ICC_NAME)) {
        int failed = vips_icc_transform(*image, &made, "srgb", "embedded", TRUE, "depth", 16, "intent",
                                        VIPS_INTENT_RELATIVE, NULL);
        VipsImage *pixels = failed ? NULL : vips_image_copy_memory(made);
        if (made) g_object_unref(made);
        if (replace(image, pixels, pixels == NULL)) return true;
        vips_error_clear();
    }
    if (is_plain(vips_image_get_interpretation(*image))) return true;
    return replace(image, made, vips_colourspace(*image, &made, VIPS_INTERPRETATION_sRGB, NULL));
}

/* Samples of band 0 .. channels-1 to floats by a table, or as they are. */
static void spread(const void *from, VipsBandFormat format, int bands, const float *table, img *out)
{
    ptrdiff_t pixels = (ptrdiff_t)out->width * out->height;
    int channels = out->channels;
    const uint8_t *codes8 = from;
    const uint16_t *codes16 = from;
    const float *floats = from;
#pragma omp parallel for schedule(static) if (pixels > 1 << 18)
    for (ptrdiff_t i = 0; i < pixels; i++)
        for (int c = 0; c < channels; c++) {
            ptrdiff_t at = i * bands + c;
            float x = format == VIPS_FORMAT_FLOAT ? floats[at] : 0;
            if (format == VIPS_FORMAT_UCHAR) x = table ? table[codes8[at]] : (float)codes8[at] / 255;
            if (format == VIPS_FORMAT_USHORT) x = table ? table[codes16[at]] : (float)codes16[at] / 65535;
            out->data[i * channels + c] = x;
        }
}

/* Takes the pixels out of libvips; decode: integers are sRGB. */
static status take(VipsImage *image, const char *path, bool decode, img *out)
{
    int bands = vips_image_get_bands(image);
    VipsBandFormat format = vips_image_get_format(image);
    VipsImage *cast = NULL;
    if (format != VIPS_FORMAT_UCHAR && format != VIPS_FORMAT_USHORT && format != VIPS_FORMAT_FLOAT &&
        format != VIPS_FORMAT_DOUBLE)
        return fail(ERROR_INPUT, "cannot read %s: its samples are of type %s; 8 or 16 bits or floats are read", path,
                    vips_enum_nick(VIPS_TYPE_BAND_FORMAT, format));
    if (format == VIPS_FORMAT_DOUBLE) format = VIPS_FORMAT_FLOAT;
    if (vips_cast(image, &cast, format, NULL)) return vips_refusal(ERROR_INPUT, "read", path);
    size_t size = 0;
    void *samples = vips_image_write_to_memory(cast, &size);
    int width = vips_image_get_width(cast), height = vips_image_get_height(cast);
    g_object_unref(cast);
    if (!samples) return vips_refusal(ERROR_INPUT, "read", path);
    status s = img_new(out, width, height, bands < 3 ? 1 : 3);
    const float *table = format == VIPS_FORMAT_USHORT ? srgb_decode_table16() : srgb_decode_table8();
    if (s == OK) spread(samples, format, bands, decode ? table : NULL, out);
    g_free(samples);
    return s;
}

static status decode_open(VipsImage **image, VipsImage **opacity, const char *path, picture_colour how, img *color,
                          img *alpha)
{
    bool decode = how == PICTURE_LINEARIZE;
    if (!load_upright(image) || !split_alpha(image, opacity) || (decode && !convert_space(image)))
        return vips_refusal(ERROR_INPUT, "read", path);
    status s = take(*image, path, decode, color);
    if (s == OK && alpha && *opacity) s = take(*opacity, path, false, alpha);
    return s;
}

status picture_decode(const char *path, picture_colour how, img *color, img *alpha)
{
    VipsImage *image = NULL, *opacity = NULL;
    status s = vips_begin();
    if (s == OK) s = open_picture(path, &image);
    if (s == OK) s = decode_open(&image, &opacity, path, how, color, alpha);
    if (image) g_object_unref(image);
    if (opacity) g_object_unref(opacity);
    return s;
}

status picture_bits(const char *path, int *bits)
{
    VipsImage *image = NULL;
    status s = vips_begin();
    if (s == OK) s = open_picture(path, &image);
    if (s != OK) return s;
    VipsBandFormat format = vips_image_get_format(image);
    *bits = format == VIPS_FORMAT_UCHAR ? 8 : format == VIPS_FORMAT_USHORT ? 16 : 32;
    g_object_unref(image);
    return OK;
}
