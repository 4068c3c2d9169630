/* SPDX-License-Identifier: MIT */
#include "serve/jobs/resized.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "merlin/pictures.h"

status resized_reduce(const merlin_image *image, int side, merlin_image *out)
{
    const int longer = image->width > image->height ? image->width : image->height;
    const double scale = longer > side ? (double)side / longer : 1;
    return merlin_image_resize(image, (int)fmax(1, round(image->width * scale)),
                               (int)fmax(1, round(image->height * scale)), out);
}

/* Finds the two of `from` pixels between which the centre of pixel `at` of `to` lies, and returns its position between
 * them. */
static float between(int at, int to, int from, int *first, int *second)
{
    const double place = fmin(fmax((at + 0.5) * from / to - 0.5, 0), from - 1);
    *first = (int)place;
    *second = *first + 1 < from ? *first + 1 : *first;
    return (float)(place - *first);
}

static void enlarge(const merlin_image *in, const merlin_image *out)
{
    for (int y = 0; y < out->height; y++) {
        int above, below, left, right;
        const float v = between(y, out->height, in->height, &above, &below);
        const float *up = in->data + (size_t)above * in->width, *down = in->data + (size_t)below * in->width;
        for (int x = 0; x < out->width; x++) {
            const float u = between(x, out->width, in->width, &left, &right);
            out->data[(size_t)y * out->width + x] =
                (1 - v) * ((1 - u) * up[left] + u * up[right]) + v * ((1 - u) * down[left] + u * down[right]);
        }
    }
}

status resized_enlarge(merlin_image *mask, int width, int height)
{
    if (mask->width == width && mask->height == height) return OK;
    const double by = fmax((double)width / mask->width, (double)height / mask->height);
    const bool alike = fabs(mask->width * by - width) <= by && fabs(mask->height * by - height) <= by;
    if (by < 1 || !alike)
        return fail(MERLIN_BAD_INPUT, "the mask has %d x %d pixels and the photograph %d x %d: one shape is needed",
                    mask->width, mask->height, width, height);
    merlin_image larger = {width, height, 1, malloc((size_t)width * (size_t)height * sizeof(float))};
    if (!larger.data) return fail(MERLIN_NO_MEMORY, "no memory for a mask of %d x %d pixels", width, height);
    enlarge(mask, &larger);
    merlin_image_free(mask);
    *mask = larger;
    return OK;
}
