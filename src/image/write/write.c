/* SPDX-License-Identifier: MIT */
#include "image/write/write.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/number.h"
#include "image/color.h"
#include "image/write/codes.h"
#include "image/write/jpeg.h"

static void encode(const float *values, size_t count, img_encoding encoding, void *codes)
{
    uint8_t *out8 = codes;
    uint16_t *out16 = codes;
    if (encoding == IMG_SRGB8) srgb_codes8(values, count, codes);
    for (size_t i = 0; encoding != IMG_SRGB8 && i < count; i++) {
        if (encoding == IMG_LINEAR8)
            out8[i] = (uint8_t)(clamp(values[i], 0, 1) * 255 + 0.5f);
        else
            out16[i] = (uint16_t)(clamp(values[i], 0, 1) * 65535 + 0.5f);
    }
}

/* An image being encoded. */
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

static code_rows rows_of(const encoding_job *job)
{
    return (code_rows){job->image->width,
                       job->image->height,
                       job->image->channels,
                       job->encoding == IMG_LINEAR16,
                       job->encoding == IMG_SRGB8,
                       encode_row,
                       job};
}

status img_write_png_changed(const char *path, const img *image, img_encoding encoding, img_change change,
                             const void *context)
{
    if (!image->data || (image->channels != 1 && image->channels != 3))
        return fail(MERLIN_WRONG_USE, "cannot write %s: a PNG needs 1 or 3 channels, not %d", path, image->channels);
    encoding_job job = {image, encoding, change, context};
    code_rows rows = rows_of(&job);
    return codes_write_png(path, &rows);
}

status img_write_png(const char *path, const img *image, img_encoding encoding)
{
    return img_write_png_changed(path, image, encoding, NULL, NULL);
}

status img_encode_picture(const char *name, const img *image, img_file_kind kind, uint8_t **data, size_t *size)
{
    *data = NULL;
    if (!image->data || image->channels != 3)
        return fail(MERLIN_WRONG_USE, "cannot write %s: a picture has 3 channels, not %d", name, image->channels);
    if (kind == IMG_JPEG) return jpeg_encode(name, image, data, size);
    encoding_job job = {.image = image, .encoding = IMG_SRGB8};
    code_rows rows = rows_of(&job);
    return codes_encode_png(name, &rows, data, size);
}

status img_write_picture(const char *path, const img *image, img_file_kind kind)
{
    uint8_t *data;
    size_t size = 0;
    status s = img_encode_picture(path, image, kind, &data, &size);
    if (s == OK) s = file_write(path, data, size);
    free(data);
    return s;
}
