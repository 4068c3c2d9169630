#include "image/write.h"

#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "image/codes.h"
#include "image/color.h"
#include "image/vips_library.h"

static float unit(float x)
{
    return x > 0 ? (x < 1 ? x : 1) : 0;
}

static void encode(const float *values, size_t count, img_encoding encoding, void *codes)
{
    uint8_t *out8 = codes;
    uint16_t *out16 = codes;
    for (size_t i = 0; i < count; i++) {
        float x = values[i];
        if (encoding == IMG_SRGB8)
            out8[i] = srgb_code8(x);
        else if (encoding == IMG_LINEAR8)
            out8[i] = (uint8_t)(unit(x) * 255 + 0.5f);
        else
            out16[i] = (uint16_t)(unit(x) * 65535 + 0.5f);
    }
}

/* ---- PNG ---- */

/* An image on its way to codes. */
typedef struct encoding_job {
    const img *image;
    img_encoding encoding;
    img_change change; /* NULL: none */
    const void *context;
} encoding_job;

static void encode_row(const void *context, int y, void *codes)
{
    enum { PART = 256 };
    const encoding_job *job = context;
    size_t channels = (size_t)job->image->channels, width = (size_t)job->image->width;
    size_t bytes = channels * (job->encoding == IMG_LINEAR16 ? 2 : 1);
    for (size_t x = 0; x < width; x += PART) {
        size_t pixels = width - x < PART ? width - x : PART;
        const float *values = img_at(job->image, (int)x, y);
        float changed[3 * PART];
        if (job->change) {
            memcpy(changed, values, pixels * channels * sizeof *changed);
            job->change(job->context, (size_t)y * width + x, pixels, changed);
            values = changed;
        }
        encode(values, pixels * channels, job->encoding, (uint8_t *)codes + x * bytes);
    }
}

status img_write_png_changed(const char *path, const img *image, img_encoding encoding, img_change change,
                             const void *context)
{
    if (!image->data || (image->channels != 1 && image->channels != 3))
        return fail(ERROR_USAGE, "cannot write %s: a PNG needs 1 or 3 channels, not %d", path, image->channels);
    encoding_job job = {image, encoding, change, context};
    code_rows rows = {image->width, image->height, image->channels, encoding == IMG_LINEAR16, encoding == IMG_SRGB8,
                      encode_row,   &job};
    return codes_write_png(path, &rows);
}

status img_write_png(const char *path, const img *image, img_encoding encoding)
{
    return img_write_png_changed(path, image, encoding, NULL, NULL);
}

/* ---- animations ---- */

/* Frames' codes one under the other. */
typedef struct film {
    uint8_t *codes;
    int width, height, count;
} film;

/* A libvips image over the codes, which must outlive it; NULL if that fails. */
static VipsImage *wrap(const film *f)
{
    size_t size = 3 * (size_t)f->width * (size_t)f->height * (size_t)f->count;
    VipsImage *bare =
        vips()->image_new_from_memory(f->codes, size, f->width, f->height * f->count, 3, VIPS_FORMAT_UCHAR);
    if (!bare) return NULL;
    VipsImage *named = NULL;
    int failed = vips()->copy(bare, &named, "interpretation", VIPS_INTERPRETATION_sRGB, NULL);
    vips()->g_object_unref(bare);
    return failed ? NULL : named;
}

static status check_frames(const char *path, const img *frames, int count)
{
    if (!file_ends_in(path, ".webp") && !file_ends_in(path, ".gif"))
        return fail(ERROR_USAGE, "cannot write %s: an animation's name ends in .webp or .gif", path);
    if (count < 1) return fail(ERROR_USAGE, "cannot write %s: an animation needs at least one frame", path);
    if (file_ends_in(path, ".gif") && !vips()->type_find("VipsOperation", "gifsave_buffer"))
        return fail(ERROR_OUTPUT, "cannot write %s: this libvips has no GIF writer, use .webp", path);
    for (int i = 0; i < count; i++)
        if (!frames[i].data || frames[i].channels != 3 || frames[i].width != frames[0].width ||
            frames[i].height != frames[0].height)
            return fail(ERROR_USAGE, "cannot write %s: frame %d is not a colour image of the first one's size", path,
                        i);
    if (frames[0].height > INT_MAX / count) return fail(ERROR_USAGE, "cannot write %s: too many frames", path);
    return OK;
}

/* With the page height and the delays that libvips's writers look for. */
static int save_frames(const char *path, const film *f, int milliseconds, void **data, size_t *size)
{
    int *delays = calloc((size_t)f->count, sizeof *delays);
    VipsImage *image = delays ? wrap(f) : NULL;
    if (!image) {
        free(delays);
        return -1;
    }
    for (int i = 0; i < f->count; i++)
        delays[i] = milliseconds;
    vips()->image_set_int(image, VIPS_META_PAGE_HEIGHT, f->height);
    vips()->image_set_int(image, "loop", 0);
    vips()->image_set_array_int(image, "delay", delays, f->count);
    int failed = file_ends_in(path, ".gif") ? vips()->gifsave_buffer(image, data, size, NULL)
                                            : vips()->webpsave_buffer(image, data, size, "Q", 90, "effort", 3, NULL);
    vips()->g_object_unref(image);
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
        encode(frames[i].data, each, IMG_SRGB8, codes + each * (size_t)i);
    film f = {codes, frames[0].width, frames[0].height, count};
    void *data = NULL;
    size_t size = 0;
    if (save_frames(path, &f, milliseconds, &data, &size))
        s = vips_refusal(ERROR_OUTPUT, "write", path);
    else
        s = file_write(path, data, size);
    vips()->g_free(data);
    free(codes);
    return s;
}
