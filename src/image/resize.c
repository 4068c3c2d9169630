/* SPDX-License-Identifier: MIT */
#include "image/resize.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* One axis of a separable resampling: output i is the sum of weights[i × taps + k] × input[first[i] + k]. */
typedef struct kernel {
    int count, taps;
    int *first;
    float *weights;
} kernel;

static double lanczos3(double x)
{
    const double pi = 3.14159265358979323846;
    if (fabs(x) < 1e-9) return 1;
    if (fabs(x) >= 3) return 0;
    return 3 * sin(pi * x) * sin(pi * x / 3) / (pi * pi * x * x);
}

/* Returns the share of input pixel k that lies in [low, high]. */
static double overlap(int k, double low, double high)
{
    double share = fmin(k + 1, high) - fmax(k, low);
    return share > 0 ? share : 0;
}

static void fill_weights(kernel *k, int from, int to)
{
    double scale = (double)from / to;
    for (int i = 0; i < to; i++) {
        double low = i * scale, high = (i + 1) * scale, center = 0.5 * (low + high) - 0.5, sum = 0;
        int start = to > from ? (int)floor(center) - 2 : (int)floor(low);
        float *w = k->weights + (size_t)i * (size_t)k->taps;
        /* taps beyond the edge count for the edge pixel */
        k->first[i] = start < 0 ? 0 : start > from - k->taps ? from - k->taps : start;
        for (int t = start; t < start + 6 || (to <= from && t < high); t++) {
            int inside = t < 0 ? 0 : t >= from ? from - 1 : t;
            double weight = to > from ? lanczos3(t - center) : overlap(t, low, high);
            if (weight == 0) continue;
            w[inside - k->first[i]] += (float)weight;
            sum += weight;
        }
        for (int t = 0; t < k->taps; t++)
            w[t] /= (float)sum;
    }
}

static status kernel_new(kernel *k, int from, int to)
{
    int wanted = to > from ? 6 : (int)ceil((double)from / to) + 1;
    k->count = to;
    k->taps = wanted < from ? wanted : from;
    k->first = malloc((size_t)to * sizeof *k->first);
    k->weights = calloc((size_t)to * (size_t)k->taps, sizeof *k->weights);
    if (!k->first || !k->weights) return fail(MERLIN_NO_MEMORY, "no memory to resize an image");
    fill_weights(k, from, to);
    return OK;
}

static void kernel_free(kernel *k)
{
    free(k->first);
    free(k->weights);
}

/* Weights pixels. With a constant number of channels the sums stay in registers. */
static inline void weigh_pixels(const float *row, const int channels, const kernel *k, float *out)
{
    for (int x = 0; x < k->count; x++, out += channels) {
        const float *in = row + (size_t)k->first[x] * (size_t)channels, *w = k->weights + (size_t)x * (size_t)k->taps;
        for (int c = 0; c < channels; c++) {
            float sum = 0;
            for (int t = 0; t < k->taps; t++)
                sum += w[t] * in[t * channels + c];
            out[c] = sum;
        }
    }
}

static void resize_row(const float *row, int channels, const kernel *k, float *out)
{
    if (channels == 1)
        weigh_pixels(row, 1, k, out);
    else if (channels == 3)
        weigh_pixels(row, 3, k, out);
    else
        weigh_pixels(row, channels, k, out);
}

static const float *multiply_row(const img *from, const img *mask, int y, float *product)
{
    const float *in = img_at(from, 0, y), *cover = img_at(mask, 0, y);
    float *out = product;
    for (int x = 0; x < from->width; x++)
        for (int c = 0; c < from->channels; c++)
            *out++ = *in++ * cover[x];
    return product;
}

/* Resamples rows; mask may be NULL. */
static status resize_rows(const img *from, const img *mask, const kernel *k, img *to)
{
    int failed = 0;
#pragma omp parallel
    {
        float *product = mask ? malloc((size_t)from->width * (size_t)from->channels * sizeof *product) : NULL;
        bool ready = product || !mask;
        if (!ready) {
#pragma omp atomic write
            failed = 1;
        }
#pragma omp for schedule(static)
        for (int y = 0; y < to->height; y++) {
            if (!ready) continue;
            const float *row = mask ? multiply_row(from, mask, y, product) : img_at(from, 0, y);
            resize_row(row, from->channels, k, img_at(to, 0, y));
        }
        free(product);
    }
    return failed ? fail(MERLIN_NO_MEMORY, "no memory to resize an image") : OK;
}

/* Resamples columns; cover may be NULL. */
static void resize_columns(const img *from, const img *cover, const kernel *k, img *to)
{
#pragma omp parallel for schedule(static)
    for (int y = 0; y < to->height; y++) {
        img_span span = cover ? img_row_span(cover, y) : (img_span){0, to->width};
        int begin = span.first * to->channels, end = span.end * to->channels;
        float *out = img_at(to, 0, y);
        for (int t = 0; t < k->taps; t++) {
            const float *in = img_at(from, 0, k->first[y] + t);
            float w = k->weights[(size_t)y * (size_t)k->taps + (size_t)t];
            for (int i = begin; i < end; i++)
                out[i] += w * in[i];
        }
    }
}

/* Resamples an image. mask weights the input, cover restricts the output; either may be NULL. */
static status resize(const img *from, const img *mask, const img *cover, int width, int height, img *out)
{
    *out = (img){0};
    if (!from->data || width < 1 || height < 1)
        return fail(MERLIN_WRONG_USE, "an image of %d x %d pixels cannot become %d x %d", from->width, from->height,
                    width, height);
    img wide = {0};
    kernel across = {0}, down = {0};
    status s = kernel_new(&across, from->width, width);
    if (s == OK) s = kernel_new(&down, from->height, height);
    if (s == OK) s = img_new(&wide, width, from->height, from->channels);
    if (s == OK) s = img_new(out, width, height, from->channels);
    if (s == OK) {
        s = resize_rows(from, mask, &across, &wide);
        if (s == OK) resize_columns(&wide, cover, &down, out);
    }
    if (s != OK) img_free(out);
    kernel_free(&across);
    kernel_free(&down);
    img_free(&wide);
    return s;
}

status img_resize(const img *from, int width, int height, img *out)
{
    if (from->data && width == from->width && height == from->height) return img_copy(out, from);
    return resize(from, NULL, NULL, width, height, out);
}

status img_resize_covered(const img *from, const img *cover, img *out)
{
    int width = cover->width, height = cover->height;
    if (from->width != width || from->height != height) return resize(from, NULL, cover, width, height, out);
    status s = img_new(out, width, height, from->channels);
    for (int y = 0; s == OK && y < height; y++) {
        img_span k = img_row_span(cover, y);
        memcpy(img_at(out, k.first, y), img_at(from, k.first, y),
               (size_t)(k.end - k.first) * (size_t)from->channels * sizeof(float));
    }
    return s;
}

status img_resize_masked(const img *from, const img *mask, int width, int height, img *out)
{
    if (!mask->data || mask->channels != 1 || mask->width != from->width || mask->height != from->height)
        return fail(MERLIN_WRONG_USE, "an image of %d x %d pixels cannot be masked by one of %d x %d", from->width,
                    from->height, mask->width, mask->height);
    if (width != from->width || height != from->height) return resize(from, mask, NULL, width, height, out);
    status s = img_new(out, width, height, from->channels);
    for (int y = 0; s == OK && y < height; y++)
        multiply_row(from, mask, y, img_at(out, 0, y));
    return s;
}

status img_crop(const img *from, int x, int y, int width, int height, img *out)
{
    status s = img_new(out, width, height, from->channels);
    if (s != OK) return s;
    int left = x < 0 ? 0 : x, right = from->width - x < width ? from->width : x + width;
    int top = y < 0 ? 0 : y, bottom = from->height - y < height ? from->height : y + height;
    if (left >= right) return OK;
    size_t bytes = (size_t)(right - left) * (size_t)from->channels * sizeof(float);
    for (int row = top; row < bottom; row++)
        memcpy(img_at(out, left - x, row - y), img_at(from, left, row), bytes);
    return OK;
}
