/* SPDX-License-Identifier: MIT */
/* Masked losses. Pixels outside the mask are never read, so that they may hold anything.
 *
 * Sums are taken over a fixed number of blocks of rows, then over the blocks in order: the same bits for any number of
 * threads. */
#include "nn/cpu/kernels/kernels.h"

#include "nn/cpu/kernels/chunk.h"

enum { BLOCKS = 64 };

typedef struct partial {
    double error, mask;
} partial;

typedef struct operands {
    const float *prediction, *target, *mask;
    size_t height, width, channels;
} operands;

static operands operands_of(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask)
{
    return (operands){prediction->data,      target->data,          mask->data,
                      (size_t)prediction->h, (size_t)prediction->w, (size_t)prediction->c};
}

/* Adds row `row` of the batch to p. */
typedef void row_sum(const operands *o, size_t row, partial *p);

static partial sum_rows(const operands *o, size_t rows, row_sum *f)
{
    partial blocks[BLOCKS] = {{0, 0}}, total = {0, 0};
#pragma omp parallel for schedule(static) if (rows * o->width * o->channels > CPU_PARALLEL_MIN)
    for (size_t b = 0; b < BLOCKS; b++)
        for (size_t row = rows * b / BLOCKS; row < rows * (b + 1) / BLOCKS; row++)
            f(o, row, &blocks[b]);
    for (size_t b = 0; b < BLOCKS; b++) {
        total.error += blocks[b].error;
        total.mask += blocks[b].mask;
    }
    return total;
}

static float loss_of(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask, double *mask_sum,
                     row_sum *f)
{
    operands o = operands_of(prediction, target, mask);
    partial total = sum_rows(&o, (size_t)prediction->n * o.height, f);
    *mask_sum = total.mask;
    return total.mask > 0 ? (float)(total.error / total.mask) : 0;
}

static inline void add_row(const operands *o, size_t row, size_t channels, partial *p)
{
    size_t at = row * o->width;
    const float *a = o->prediction + at * channels, *b = o->target + at * channels, *m = o->mask + at;
    double error = 0, mask = 0;
#pragma omp simd reduction(+ : error, mask)
    for (size_t i = 0; i < o->width; i++) {
        mask += m[i];
        for (size_t c = 0; c < channels; c++) {
            float e = m[i] != 0 ? (a[i * channels + c] - b[i * channels + c]) * m[i] : 0;
            error += (double)e * (double)e;
        }
    }
    p->error += error;
    p->mask += mask;
}

static void masked_l2_row(const operands *o, size_t row, partial *p)
{
    /* constant counts for the maps' one and three channels, so that the loop over pixels vectorizes */
    if (o->channels == 1)
        add_row(o, row, 1, p);
    else if (o->channels == 3)
        add_row(o, row, 3, p);
    else
        add_row(o, row, o->channels, p);
}

float cpu_masked_l2(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask, double *mask_sum)
{
    return loss_of(prediction, target, mask, mask_sum, masked_l2_row);
}

void cpu_masked_l2_backward(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask,
                            double mask_sum, float scale, cpu_tensor *dprediction, bool accumulate)
{
    operands o = operands_of(prediction, target, mask);
    size_t rows = (size_t)prediction->n * o.height;
    float factor = mask_sum > 0 ? (float)(2 * (double)scale / mask_sum) : 0;
#pragma omp parallel for schedule(static) if (cpu_count(prediction) > CPU_PARALLEL_MIN)
    for (size_t row = 0; row < rows; row++)
        for (size_t i = row * o.width; i < (row + 1) * o.width; i++) {
            float m = o.mask[i];
            for (size_t k = i * o.channels; k < (i + 1) * o.channels; k++) {
                float *d = (float *)dprediction->data + k;
                float g = m != 0 ? factor * m * m * (o.prediction[k] - o.target[k]) : 0;
                *d = (accumulate ? *d : 0) + g;
            }
        }
}

static bool inside(const operands *o, size_t pixel)
{
    return o->mask[pixel] > 0.5f;
}

/* Returns the error at pixel b minus that at pixel a; zero unless both are inside the mask. */
static float difference(const operands *o, size_t a, size_t b, size_t channel)
{
    if (!inside(o, a) || !inside(o, b)) return 0;
    size_t i = a * o->channels + channel, j = b * o->channels + channel;
    return (o->prediction[j] - o->target[j]) - (o->prediction[i] - o->target[i]);
}

static void masked_gradient_row(const operands *o, size_t row, partial *p)
{
    bool below = row % o->height + 1 < o->height;
    for (size_t x = 0; x < o->width; x++) {
        size_t i = row * o->width + x;
        p->mask += o->mask[i];
        if (!inside(o, i)) continue;
        for (size_t c = 0; c < o->channels; c++) {
            float right = x + 1 < o->width ? difference(o, i, i + 1, c) : 0;
            float down = below ? difference(o, i, i + o->width, c) : 0;
            p->error += (double)right * (double)right + (double)down * (double)down;
        }
    }
}

float cpu_masked_gradient_l2(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask,
                             double *mask_sum)
{
    return loss_of(prediction, target, mask, mask_sum, masked_gradient_row);
}

/* Returns the gradient at pixel i from the four differences in which it takes part. */
static float pull(const operands *o, size_t i, size_t channel)
{
    size_t x = i % o->width, y = i / o->width % o->height;
    float g = 0;
    if (x > 0) g += difference(o, i - 1, i, channel);
    if (x + 1 < o->width) g -= difference(o, i, i + 1, channel);
    if (y > 0) g += difference(o, i - o->width, i, channel);
    if (y + 1 < o->height) g -= difference(o, i, i + o->width, channel);
    return g;
}

void cpu_masked_gradient_l2_backward(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask,
                                     double mask_sum, float scale, cpu_tensor *dprediction, bool accumulate)
{
    operands o = operands_of(prediction, target, mask);
    size_t rows = (size_t)prediction->n * o.height;
    float factor = mask_sum > 0 ? (float)(2 * (double)scale / mask_sum) : 0;
#pragma omp parallel for schedule(static) if (cpu_count(prediction) > CPU_PARALLEL_MIN)
    for (size_t row = 0; row < rows; row++)
        for (size_t i = row * o.width; i < (row + 1) * o.width; i++)
            for (size_t c = 0; c < o.channels; c++) {
                float *d = (float *)dprediction->data + i * o.channels + c;
                float g = inside(&o, i) ? factor * pull(&o, i, c) : 0;
                *d = (accumulate ? *d : 0) + g;
            }
}
