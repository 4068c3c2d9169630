/* SPDX-License-Identifier: MIT */
#include "nn/cpu/kernels/norm.h"

#include <math.h>

#include "base/half.h"
#include "base/inline.h"

enum { CHUNKS = 64 };

size_t norm_partial_floats(int channels)
{
    return (size_t)CHUNKS * 2 * (size_t)channels + 4 * (size_t)channels;
}

/* Loads an element as float. Loops are written once for both types; `bf16` is a constant in every caller, so that they
 * compile to vector code. */
ALWAYS_INLINE float load(const void *data, size_t i, bool bf16)
{
    return bf16 ? bf16_to_float(((const uint16_t *)data)[i]) : ((const float *)data)[i];
}

ALWAYS_INLINE void store(void *data, size_t i, float x, bool bf16)
{
    if (!bf16) {
        ((float *)data)[i] = x;
        return;
    }
    uint32_t u = float_bits(x); /* a NaN that arithmetic produced remains one after this rounding */
    ((uint16_t *)data)[i] = (uint16_t)((u + 0x7fffu + ((u >> 16) & 1u)) >> 16);
}

typedef struct rows {
    size_t begin, end;
} rows;

static rows chunk_rows(const nn_tensor *x, int chunk)
{
    size_t count = (size_t)x->n * (size_t)x->h * (size_t)x->w;
    return (rows){count * (size_t)chunk / CHUNKS, count * ((size_t)chunk + 1) / CHUNKS};
}

/* Sums (x - origin) and its square over a chunk; origin, the first row, avoids cancellation for a large mean. */
ALWAYS_INLINE void sum_rows(const nn_tensor *x, rows r, float *restrict sum, float *restrict square, bool bf16)
{
    const int c = x->c;
    const void *restrict data = x->data;
    for (int i = 0; i < c; i++)
        sum[i] = square[i] = 0;
    for (size_t row = r.begin; row < r.end; row++) {
        for (int i = 0; i < c; i++) {
            float d = load(data, row * (size_t)c + (size_t)i, bf16) - load(data, (size_t)i, bf16);
            sum[i] += d;
            square[i] += d * d;
        }
    }
}

/* Computes mean and mean square of all ranks' rows from each rank's mean and variance. */
static status join_statistics(const ranks *together, int channels, double *sums, float *mean, float *variance)
{
    const double count = ranks_count(together);
    double *means = sums, *squares = sums + channels;
    for (int i = 0; i < channels; i++) {
        means[i] = (double)mean[i];
        squares[i] = (double)variance[i] + means[i] * means[i];
    }
    status s = ranks_sum(together, sums, 2 * (size_t)channels);
    for (int i = 0; i < channels; i++) {
        double m = means[i] / count, v = squares[i] / count - m * m;
        mean[i] = (float)m;
        variance[i] = v > 0 ? (float)v : 0;
    }
    return s;
}

status norm_statistics(const nn_tensor *x, const ranks *together, float *partial, double *sums, float *mean,
                       float *variance)
{
    const int c = x->c;
    const bool bf16 = x->type == NN_BFLOAT16;
    const double count = (double)x->n * x->h * x->w;
#pragma omp parallel for schedule(static)
    for (int k = 0; k < CHUNKS; k++) {
        float *sum = partial + (size_t)k * 2 * (size_t)c;
        if (bf16)
            sum_rows(x, chunk_rows(x, k), sum, sum + c, true);
        else
            sum_rows(x, chunk_rows(x, k), sum, sum + c, false);
    }
    for (int i = 0; i < c; i++) {
        double sum = 0, square = 0;
        for (int k = 0; k < CHUNKS; k++) {
            sum += (double)partial[(size_t)k * 2 * (size_t)c + (size_t)i];
            square += (double)partial[((size_t)k * 2 + 1) * (size_t)c + (size_t)i];
        }
        double d = sum / count, v = square / count - d * d;
        mean[i] = (float)(d + (double)load(x->data, (size_t)i, bf16));
        variance[i] = v > 0 ? (float)v : 0;
    }
    return ranks_count(together) > 1 ? join_statistics(together, c, sums, mean, variance) : OK;
}

ALWAYS_INLINE void apply_rows(const nn_tensor *x, rows r, const float *restrict scale, const float *restrict shift,
                              bool relu, nn_tensor *y, bool bf16)
{
    const size_t c = (size_t)x->c;
    const void *restrict from = x->data;
    void *restrict to = y->data;
    for (size_t row = r.begin; row < r.end; row++) {
        for (size_t i = 0; i < c; i++) {
            float v = scale[i] * load(from, row * c + i, bf16) + shift[i];
            store(to, row * c + i, relu && v < 0 ? 0 : v, bf16);
        }
    }
}

void norm_apply(const nn_tensor *x, const float *scale, const float *shift, bool relu, nn_tensor *y)
{
#pragma omp parallel for schedule(static)
    for (int k = 0; k < CHUNKS; k++) {
        rows r = chunk_rows(x, k);
        if (x->type == NN_BFLOAT16)
            apply_rows(x, r, scale, shift, relu, y, true);
        else
            apply_rows(x, r, scale, shift, relu, y, false);
    }
}

/* Coefficients per channel: x̂ = a x + b, and the result is γ x̂ + β. */
typedef struct affine {
    float *restrict a, *restrict b;
    const float *restrict gamma, *restrict beta;
} affine;

/* Sums dy and dy·x̂ over a chunk, where ReLU passed. */
ALWAYS_INLINE void sum_gradients(const nn_tensor *x, const nn_tensor *dy, rows r, const affine *f, bool relu,
                                 float *restrict sum, float *restrict product, bool bf16)
{
    const size_t c = (size_t)x->c;
    const void *restrict xs = x->data, *restrict gs = dy->data;
    const float *restrict a = f->a, *restrict b = f->b, *restrict gamma = f->gamma, *restrict beta = f->beta;
    for (size_t i = 0; i < c; i++)
        sum[i] = product[i] = 0;
    for (size_t row = r.begin; row < r.end; row++) {
        for (size_t i = 0; i < c; i++) {
            float n = a[i] * load(xs, row * c + i, bf16) + b[i], g = load(gs, row * c + i, bf16);
            if (relu) g = gamma[i] * n + beta[i] > 0 ? g : 0;
            sum[i] += g;
            product[i] += g * n;
        }
    }
}

/* Coefficients of dx = γ/σ (dy - mean(dy) - x̂ mean(dy x̂)), that is factor (dy - offset - x̂ slope). */
typedef struct input_gradient {
    const float *restrict factor, *restrict offset, *restrict slope;
} input_gradient;

ALWAYS_INLINE void write_gradients(const nn_tensor *x, const nn_tensor *dy, rows r, const affine *f, bool relu,
                                   const input_gradient *w, nn_tensor *dx, bool add, bool bf16)
{
    const size_t c = (size_t)x->c;
    const void *restrict xs = x->data, *restrict gs = dy->data;
    void *restrict out = dx->data;
    const float *restrict a = f->a, *restrict b = f->b, *restrict gamma = f->gamma, *restrict beta = f->beta;
    const float *restrict factor = w->factor, *restrict offset = w->offset, *restrict slope = w->slope;
    for (size_t row = r.begin; row < r.end; row++) {
        for (size_t i = 0; i < c; i++) {
            size_t at = row * c + i;
            float n = a[i] * load(xs, at, bf16) + b[i], g = load(gs, at, bf16);
            if (relu) g = gamma[i] * n + beta[i] > 0 ? g : 0;
            float d = factor[i] * (g - offset[i] - n * slope[i]);
            store(out, at, add ? d + load(out, at, bf16) : d, bf16);
        }
    }
}

static void gradient_chunk(const nn_tensor *x, const nn_tensor *dy, rows r, const affine *f, bool relu,
                           const input_gradient *w, nn_tensor *dx, bool add)
{
    if (x->type == NN_BFLOAT16 && relu && !add)
        write_gradients(x, dy, r, f, true, w, dx, false, true);
    else if (x->type == NN_BFLOAT16)
        write_gradients(x, dy, r, f, relu, w, dx, add, true);
    else
        write_gradients(x, dy, r, f, relu, w, dx, add, false);
}

status norm_backward(const nn_tensor *x, const nn_tensor *dy, bool relu, const norm_channels *c, const ranks *together,
                     float *partial, double *sums, nn_tensor *dx, bool accumulate)
{
    const size_t channels = (size_t)x->c;
    const double count = (double)x->n * x->h * x->w * ranks_count(together);
    double *products = sums + channels;
    float *a = partial + CHUNKS * 2 * channels, *b = a + channels, *offset = b + channels, *slope = offset + channels;
    for (size_t i = 0; i < channels; i++) {
        a[i] = c->inverse_deviation[i];
        b[i] = -c->mean[i] * c->inverse_deviation[i];
    }
    const affine f = {a, b, c->gamma, c->beta};
#pragma omp parallel for schedule(static)
    for (int k = 0; k < CHUNKS; k++) {
        float *sum = partial + (size_t)k * 2 * channels;
        if (x->type == NN_BFLOAT16)
            sum_gradients(x, dy, chunk_rows(x, k), &f, relu, sum, sum + channels, true);
        else
            sum_gradients(x, dy, chunk_rows(x, k), &f, relu, sum, sum + channels, false);
    }
    for (size_t i = 0; i < channels; i++) {
        double sum = 0, product = 0;
        for (size_t k = 0; k < CHUNKS; k++) {
            sum += (double)partial[k * 2 * channels + i];
            product += (double)partial[(k * 2 + 1) * channels + i];
        }
        c->dbeta[i] = (float)sum;
        c->dgamma[i] = (float)product;
        sums[i] = sum;
        products[i] = product;
    }
    status s = ranks_sum(together, sums, 2 * channels);
    if (s != OK || !dx) return s;
    for (size_t i = 0; i < channels; i++) {
        offset[i] = (float)(sums[i] / count);
        slope[i] = (float)(products[i] / count);
    }
    /* the sums are no longer needed: γ/σ takes their place */
    for (size_t i = 0; i < channels; i++)
        partial[i] = c->gamma[i] * c->inverse_deviation[i];
    const input_gradient w = {partial, offset, slope};
#pragma omp parallel for schedule(static)
    for (int k = 0; k < CHUNKS; k++)
        gradient_chunk(x, dy, chunk_rows(x, k), &f, relu, &w, dx, accumulate);
    return OK;
}
