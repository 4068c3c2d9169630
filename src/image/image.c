/* SPDX-License-Identifier: MIT */
#include "image/image.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Makes an image with the pixels that `allocate` returns. */
static status make(img *out, int width, int height, int channels, void *(*allocate)(size_t bytes))
{
    *out = (img){0};
    if (width < 1 || height < 1 || channels < 1)
        return fail(MERLIN_WRONG_USE, "an image of %d x %d pixels and %d channels cannot be", width, height, channels);
    size_t count = 0, bytes = 0;
    if (__builtin_mul_overflow((size_t)width * (size_t)height, (size_t)channels, &count) ||
        __builtin_mul_overflow(count, sizeof(float), &bytes) || bytes > PTRDIFF_MAX)
        return fail(MERLIN_NO_MEMORY, "an image of %d x %d x %d is beyond memory", width, height, channels);
    out->data = allocate(bytes);
    if (!out->data) return fail(MERLIN_NO_MEMORY, "no memory for an image of %d x %d x %d", width, height, channels);
    out->width = width;
    out->height = height;
    out->channels = channels;
    return OK;
}

static void *zeros(size_t bytes)
{
    return calloc(1, bytes);
}

status img_new(img *out, int width, int height, int channels)
{
    return make(out, width, height, channels, zeros);
}

void img_free(img *image)
{
    if (!image) return;
    free(image->data);
    *image = (img){0};
}

void merlin_image_free(merlin_image *image)
{
    img_free(image);
}

status img_make_color(img *image)
{
    if (image->channels == 3) return OK;
    img color;
    status s = img_new(&color, image->width, image->height, 3);
    if (s != OK) return s;
    const size_t count = img_value_count(&color);
    for (size_t i = 0; i < count; i++)
        color.data[i] = image->data[i / 3];
    img_free(image);
    *image = color;
    return OK;
}

status img_copy(img *out, const img *from)
{
    status s = make(out, from->width, from->height, from->channels, malloc);
    if (s != OK) return s;
    size_t count = (size_t)from->width * (size_t)from->height * (size_t)from->channels;
    memcpy(out->data, from->data, count * sizeof(float));
    return OK;
}

img_span img_row_span(const img *mask, int y)
{
    const float *row = img_at(mask, 0, y);
    img_span s = {0, mask->width};
    while (s.end > 0 && row[s.end - 1] == 0)
        s.end--;
    while (s.first < s.end && row[s.first] == 0)
        s.first++;
    return s;
}

void img_zero_invalid(img *image)
{
    for (size_t i = 0, n = img_value_count(image); i < n; i++)
        if (!(isfinite(image->data[i]) && image->data[i] >= 0)) image->data[i] = 0;
}

void img_add(const img *part, img *sum)
{
    for (size_t i = 0, n = (size_t)sum->width * (size_t)sum->height * (size_t)sum->channels; i < n; i++)
        if (part->data[i] != 0) sum->data[i] += part->data[i];
}

status img_check_numbers(const img *image)
{
    const size_t count = img_value_count(image);
    for (size_t i = 0; i < count; i++) {
        if (!isnan(image->data[i])) continue;
        const size_t pixel = i / (size_t)image->channels, width = (size_t)image->width;
        return fail(MERLIN_BAD_INPUT, "the image is not a number (NaN) at %zu,%zu (column, row)", pixel % width,
                    pixel / width);
    }
    return OK;
}

double img_mean_within(const img *a, const img *mask)
{
    size_t count = 0;
    double sum = 0;
    for (size_t i = 0, pixels = (size_t)a->width * (size_t)a->height; i < pixels; i++) {
        if (!(mask->data[i] > 0.5f)) continue;
        sum += (double)a->data[i];
        count++;
    }
    return count ? sum / (double)count : 0;
}
