/* SPDX-License-Identifier: MIT */
#include "estimate/surface/fill.h"

#include <stdbool.h>
#include <string.h>

#include "base/number.h"
#include "base/parallel.h"

/* A picture and its valid pixels, both at one level of the pyramid. */
typedef struct level {
    img *fine;
    const img *valid;
    img coarse, coarse_valid;
} level;

/* Halves the size; each pixel is the mean of its valid children, and valid if any child is. */
static void pull_rows(void *context, size_t begin, size_t end)
{
    level *l = context;
    const img *fine = l->fine;
    for (int y = (int)begin; y < (int)end; y++) {
        for (int x = 0; x < l->coarse.width; x++) {
            float *sum = img_at(&l->coarse, x, y), weight = 0;
            for (int i = 0; i < 4; i++) {
                int u = 2 * x + (i & 1), v = 2 * y + (i >> 1);
                if (u >= fine->width || v >= fine->height || *img_at(l->valid, u, v) < 0.5f) continue;
                const float *child = img_at(fine, u, v);
                for (int c = 0; c < fine->channels; c++)
                    sum[c] += child[c];
                weight += 1;
            }
            for (int c = 0; c < fine->channels && weight > 0; c++)
                sum[c] /= weight;
            *img_at(&l->coarse_valid, x, y) = weight > 0;
        }
    }
}

/* Interpolates the coarse level bilinearly at the centre of a fine pixel. */
static void sample(const img *coarse, int x, int y, float *out)
{
    int x0 = (x - 1) >> 1, y0 = (y - 1) >> 1;
    float u = x & 1 ? 0.25f : 0.75f, v = y & 1 ? 0.25f : 0.75f;
    const int last_column = coarse->width - 1, last_row = coarse->height - 1;
    int left = clamp_int(x0, 0, last_column), right = clamp_int(x0 + 1, 0, last_column);
    int top = clamp_int(y0, 0, last_row), bottom = clamp_int(y0 + 1, 0, last_row);
    const float *top_left = img_at(coarse, left, top), *top_right = img_at(coarse, right, top);
    const float *bottom_left = img_at(coarse, left, bottom), *bottom_right = img_at(coarse, right, bottom);
    for (int c = 0; c < coarse->channels; c++) {
        float above = (1 - u) * top_left[c] + u * top_right[c];
        float below = (1 - u) * bottom_left[c] + u * bottom_right[c];
        out[c] = (1 - v) * above + v * below;
    }
}

static void push_rows(void *context, size_t begin, size_t end)
{
    const level *l = context;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < l->fine->width; x++)
            if (*img_at(l->valid, x, y) < 0.5f) sample(&l->coarse, x, y, img_at(l->fine, x, y));
}

status fill_outside(img *image, const img *mask)
{
    if (image->width == 1 && image->height == 1) {
        if (mask->data[0] < 0.5f) memset(image->data, 0, (size_t)image->channels * sizeof(float));
        return OK;
    }
    level l = {.fine = image, .valid = mask};
    int width = (image->width + 1) / 2, height = (image->height + 1) / 2;
    status s = img_new(&l.coarse, width, height, image->channels);
    if (s == OK) s = img_new(&l.coarse_valid, width, height, 1);
    if (s == OK) {
        parallel_blocks((size_t)height, pull_rows, &l);
        s = fill_outside(&l.coarse, &l.coarse_valid);
    }
    if (s == OK) parallel_blocks((size_t)image->height, push_rows, &l);
    img_free(&l.coarse);
    img_free(&l.coarse_valid);
    return s;
}
