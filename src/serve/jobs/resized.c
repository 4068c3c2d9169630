/* SPDX-License-Identifier: MIT */
#include "serve/jobs/resized.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static status make(merlin_image *image, int width, int height, int channels)
{
    *image = (merlin_image){width, height, channels, calloc((size_t)width * height, channels * sizeof(float))};
    return image->data ? OK : fail(MERLIN_NO_MEMORY, "no memory for a picture of %d x %d pixels", width, height);
}

/* Returns the first of `size` pixels in block number `at` of `parts`. */
static int edge(int at, int parts, int size)
{
    return (int)((long long)at * size / parts);
}

static void mean(const merlin_image *in, const int box[4], float *out)
{
    for (int c = 0; c < in->channels; c++) {
        double sum = 0;
        for (int y = box[1]; y < box[3]; y++)
            for (int x = box[0]; x < box[2]; x++)
                sum += in->data[((size_t)y * in->width + x) * in->channels + c];
        out[c] = (float)(sum / ((double)(box[2] - box[0]) * (box[3] - box[1])));
    }
}

status resized_reduce(const merlin_image *image, int side, merlin_image *out)
{
    const int longer = image->width > image->height ? image->width : image->height;
    const double scale = longer > side ? (double)side / longer : 1;
    const int width = (int)fmax(1, round(image->width * scale)), height = (int)fmax(1, round(image->height * scale));
    status s = make(out, width, height, image->channels);
    for (int y = 0; y < height && s == OK; y++)
        for (int x = 0; x < width; x++) {
            const int box[4] = {edge(x, width, image->width), edge(y, height, image->height),
                                edge(x + 1, width, image->width), edge(y + 1, height, image->height)};
            mean(image, box, &out->data[((size_t)y * width + x) * image->channels]);
        }
    return s;
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
    merlin_image larger;
    if (mask->width == width && mask->height == height) return OK;
    const double by = fmax((double)width / mask->width, (double)height / mask->height);
    const bool alike = fabs(mask->width * by - width) <= by && fabs(mask->height * by - height) <= by;
    if (by < 1 || !alike)
        return fail(MERLIN_BAD_INPUT, "the mask has %d x %d pixels and the photograph %d x %d: one shape is needed",
                    mask->width, mask->height, width, height);
    status s = make(&larger, width, height, 1);
    if (s != OK) return s;
    enlarge(mask, &larger);
    merlin_image_free(mask);
    *mask = larger;
    return OK;
}
