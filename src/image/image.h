/* SPDX-License-Identifier: MIT */
/* Float images, interleaved, rows from the top, linear sRGB primaries unless a name says otherwise.
 *
 * A large new image takes memory only where something was written: what is done to the pictures of an object leaves the
 * zeros beside it alone. */
#ifndef MERLIN_IMAGE_IMAGE_H
#define MERLIN_IMAGE_IMAGE_H

#include <stddef.h>

#include "base/status.h"
#include "merlin/image.h"

/* The library's own image, by a short name for the inside. */
typedef merlin_image img;

/* Zero-filled. Refuses sizes below 1 or beyond memory. img_free leaves an empty image; freeing one is fine. */
status img_new(img *out, int width, int height, int channels);
void img_free(img *image);
status img_copy(img *out, const img *from);

/* Where a row of a mask (1 channel) is not zero: from its first such pixel to before `end`; 0 to 0 if nowhere. */
typedef struct img_span {
    int first, end;
} img_span;
img_span img_row_span(const img *mask, int y);

/* The pixels that share a side with one: left, right, above, below, but for what is beside the picture. Returns how
 * many. */
static inline int img_beside(int width, int height, size_t pixel, size_t to[4])
{
    const size_t w = (size_t)width, x = pixel % w, y = pixel / w;
    int count = 0;
    if (x > 0) to[count++] = pixel - 1;
    if (x + 1 < w) to[count++] = pixel + 1;
    if (y > 0) to[count++] = pixel - w;
    if (y + 1 < (size_t)height) to[count++] = pixel + w;
    return count;
}

/* What no light has, values that are not finite or negative, becomes 0. */
void img_zero_invalid(img *image);

/* Mean of 1 channel over the pixels where the mask, of the same size, is above a half; 0 if there are none. */
double img_mean_within(const img *a, const img *mask);

/* sum += part, of the same size; its zeros leave the sum alone. */
void img_add(const img *part, img *sum);

static inline size_t img_value_count(const img *image)
{
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels;
}

static inline float *img_at(const img *image, int x, int y)
{
    return image->data + ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
}

#endif
