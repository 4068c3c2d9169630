#include "image/write.h"

#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "image/codes.h"
#include "image/color.h"
#include "image/exr.h"
#include "image/start.h"

static float unit(float x)
{
    return x > 0 ? (x < 1 ? x : 1) : 0;
}

static void encode(const img *image, img_encoding encoding, void *codes)
{
    ptrdiff_t count = (ptrdiff_t)image->width * image->height * image->channels;
    uint8_t *out8 = codes;
    uint16_t *out16 = codes;
#pragma omp parallel for schedule(static) if (count > 1 << 18)
    for (ptrdiff_t i = 0; i < count; i++) {
        float x = image->data[i];
        if (encoding == IMG_SRGB8)
            out8[i] = srgb_code8(x);
        else if (encoding == IMG_LINEAR8)
            out8[i] = (uint8_t)(unit(x) * 255 + 0.5f);
        else
            out16[i] = (uint16_t)(unit(x) * 65535 + 0.5f);
    }
}

static VipsInterpretation interpretation(int channels, img_encoding encoding)
{
    if (encoding == IMG_LINEAR16) return channels == 3 ? VIPS_INTERPRETATION_RGB16 : VIPS_INTERPRETATION_GREY16;
    return channels == 3 ? VIPS_INTERPRETATION_sRGB : VIPS_INTERPRETATION_B_W;
}

/* A libvips image over the codes, which must outlive it; NULL if that fails. */
static VipsImage *wrap(const pixel_codes *p)
{
    size_t size =
        (size_t)p->width * (size_t)p->height * (size_t)p->channels * (p->format == VIPS_FORMAT_USHORT ? 2 : 1);
    VipsImage *bare = vips_image_new_from_memory(p->codes, size, p->width, p->height, p->channels, p->format);
    if (!bare) return NULL;
    VipsImage *named = NULL;
    int failed = vips_copy(bare, &named, "interpretation", p->interpretation, NULL);
    g_object_unref(bare);
    return failed ? NULL : named;
}

status img_write_png(const char *path, const img *image, img_encoding encoding)
{
    if (!image->data || (image->channels != 1 && image->channels != 3))
        return fail(ERROR_USAGE, "cannot write %s: a PNG needs 1 or 3 channels, not %d", path, image->channels);
    status s = vips_begin();
    if (s != OK) return s;
    pixel_codes p = {.width = image->width,
                     .height = image->height,
                     .channels = image->channels,
                     .format = encoding == IMG_LINEAR16 ? VIPS_FORMAT_USHORT : VIPS_FORMAT_UCHAR,
                     .interpretation = interpretation(image->channels, encoding)};
    size_t count = (size_t)p.width * (size_t)p.height * (size_t)p.channels;
    p.codes = malloc(count * (encoding == IMG_LINEAR16 ? 2 : 1));
    if (!p.codes) return fail(ERROR_MEMORY, "no memory to write %s", path);
    encode(image, encoding, p.codes);
    s = codes_write_png(path, &p);
    free(p.codes);
    return s;
}

static bool ends_in(const char *path, const char *ending)
{
    size_t n = strlen(path), m = strlen(ending);
    return n > m && strcasecmp(path + n - m, ending) == 0;
}

static status check_frames(const char *path, const img *frames, int count)
{
    if (!ends_in(path, ".webp") && !ends_in(path, ".gif"))
        return fail(ERROR_USAGE, "cannot write %s: an animation's name ends in .webp or .gif", path);
    if (count < 1) return fail(ERROR_USAGE, "cannot write %s: an animation needs at least one frame", path);
    if (ends_in(path, ".gif") && !vips_type_find("VipsOperation", "gifsave_buffer"))
        return fail(ERROR_OUTPUT, "cannot write %s: this libvips has no GIF writer, use .webp", path);
    for (int i = 0; i < count; i++)
        if (!frames[i].data || frames[i].channels != 3 || frames[i].width != frames[0].width ||
            frames[i].height != frames[0].height)
            return fail(ERROR_USAGE, "cannot write %s: frame %d is not a colour image of the first one's size", path,
                        i);
    if (frames[0].height > INT_MAX / count) return fail(ERROR_USAGE, "cannot write %s: too many frames", path);
    return OK;
}

/* Frames one under the other, with the page height and the delays that libvips's writers look for. */
static int save_frames(const char *path, const pixel_codes *p, int count, int milliseconds, void **data, size_t *size)
{
    int *delays = calloc((size_t)count, sizeof *delays);
    VipsImage *image = delays ? wrap(p) : NULL;
    if (!image) {
        free(delays);
        return -1;
    }
    for (int i = 0; i < count; i++)
        delays[i] = milliseconds;
    vips_image_set_int(image, VIPS_META_PAGE_HEIGHT, p->height / count);
    vips_image_set_int(image, "loop", 0);
    vips_image_set_array_int(image, "delay", delays, count);
    int failed = ends_in(path, ".gif") ? vips_gifsave_buffer(image, data, size, NULL)
                                       : vips_webpsave_buffer(image, data, size, "Q", 90, "effort", 3, NULL);
    g_object_unref(image);
    free(delays);
    return failed;
}

status img_write_animation(const char *path, const img *frames, int count, int milliseconds)
{
    status s = vips_begin();
    if (s == OK) s = check_frames(path, frames, count);
    if (s != OK) return s;
    size_t each = (size_t)frames[0].width * (size_t)frames[0].height * 3;
    uint8_t *codes = malloc(each * (size_t)count);
    if (!codes) return fail(ERROR_MEMORY, "no memory for the %d frames of %s", count, path);
    for (int i = 0; i < count; i++)
        encode(&frames[i], IMG_SRGB8, codes + each * (size_t)i);
    pixel_codes p = {codes, frames[0].width, frames[0].height * count, 3, VIPS_FORMAT_UCHAR, VIPS_INTERPRETATION_sRGB};
    void *data = NULL;
    size_t size = 0;
    if (save_frames(path, &p, count, milliseconds, &data, &size))
        s = vips_refusal(ERROR_OUTPUT, "write", path);
    else
        s = file_write(path, data, size);
    g_free(data);
    free(codes);
    return s;
}

status img_write_exr(const char *path, const img *image)
{
    if (!image->data || image->channels != 3)
        return fail(ERROR_USAGE, "cannot write %s: a picture has 3 channels, not %d", path, image->channels);
    const exr_channel channels[] = {{"R", image->data, 3}, {"G", image->data + 1, 3}, {"B", image->data + 2, 3}};
    return exr_write(path, image->width, image->height, channels, 3, NULL, 0);
}
