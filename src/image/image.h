/* SPDX-License-Identifier: MIT */
/* Float images, interleaved, rows from the top, linear sRGB primaries unless a name says otherwise.
 *
 * A large new image takes memory only where something was written, so that functions leave the zeros around an object
 * untouched. */
#ifndef MERLIN_IMAGE_IMAGE_H
#define MERLIN_IMAGE_IMAGE_H

#include <stddef.h>

#include "base/status.h"
#include "merlin/image.h"

/* The library's public image type under a short name for internal use. */
typedef merlin_image img;

/* Allocates an image of zeros. Refuses sizes below 1 or beyond memory. img_free leaves an empty image, which may be
 * freed again. */
status img_new(img *out, int width, int height, int channels);
void img_free(img *image);
status img_copy(img *out, const img *from);

/* Gives a grey image, of 1 channel, three equal ones; leaves one of 3 as it is. MERLIN_NO_MEMORY, and then it stays. */
status img_make_color(img *image);

/* The part of a mask's row (1 channel) that is not zero: from the first such pixel to before `end`; 0 to 0 if there is
 * none. */
typedef struct img_span {
    int first, end;
} img_span;
img_span img_row_span(const img *mask, int y);

/* Lists the neighbours of a pixel inside the picture: left, right, above, below. Returns how many there are. */
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

/* Sets values that are not finite or negative, which no radiance is, to 0. */
void img_zero_invalid(img *image);

/* MERLIN_BAD_INPUT with the first place of a value that is NaN, which has no colour. Infinite ones are white or black.
 */
status img_check_numbers(const img *image);

/* Returns the mean of a 1-channel image where the mask, of the same size, is above one half; 0 if it is nowhere. */
double img_mean_within(const img *a, const img *mask);

/* Adds part to sum, of the same size; where part is zero the sum is not touched. */
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
