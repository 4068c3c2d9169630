/* SPDX-License-Identifier: MIT */
#include "nn/cpu/kernels/layer_norm.h"

#include <math.h>
#include <string.h>

#include "nn/cpu/kernels/chunk.h"

/* Added to the variance, as PyTorch does by default. */
static const float EPSILON = 1e-5f;

typedef struct pixel {
    float mean, inverse_deviation;
} pixel;

static pixel statistics(const float *x, size_t channels)
{
    float sum = 0, square = 0;
#pragma omp simd reduction(+ : sum)
    for (size_t c = 0; c < channels; c++)
        sum += x[c];
    const float mean = sum / (float)channels;
#pragma omp simd reduction(+ : square)
    for (size_t c = 0; c < channels; c++)
        square += (x[c] - mean) * (x[c] - mean);
    return (pixel){mean, 1 / sqrtf(square / (float)channels + EPSILON)};
}

static size_t pixel_count(const cpu_tensor *t)
{
    return (size_t)t->n * (size_t)t->h * (size_t)t->w;
}

void cpu_layer_norm(const cpu_tensor *x, layer_norm_params params, cpu_tensor *y)
{
    const size_t channels = (size_t)x->c, count = pixel_count(x);
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < count; i++) {
        float room_x[CPU_MAX_CHANNELS], room_y[CPU_MAX_CHANNELS];
        const float *p = cpu_load(x, i * channels, channels, room_x);
        float *q = cpu_target(y, i * channels, room_y, false);
        const pixel s = statistics(p, channels);
#pragma omp simd
        for (size_t c = 0; c < channels; c++)
            q[c] = params.weight[c] * ((p[c] - s.mean) * s.inverse_deviation) + params.bias[c];
        cpu_store(y, i * channels, channels, q, false);
    }
}

size_t layer_norm_partial_floats(int channels)
{
    return 2 * (size_t)CPU_PARTS * (size_t)channels;
}

/* Computes dx of one pixel from w = weight·dy: (w - mean(w) - x̂·mean(w·x̂)) / deviation. */
static void pixel_gradient(const float *x, pixel s, const float *weight, const float *dy, size_t channels, float *dx)
{
    float sum = 0, product = 0;
#pragma omp simd reduction(+ : sum, product)
    for (size_t c = 0; c < channels; c++) {
        const float w = weight[c] * dy[c];
        sum += w;
        product += w * ((x[c] - s.mean) * s.inverse_deviation);
    }
    sum /= (float)channels;
    product /= (float)channels;
#pragma omp simd
    for (size_t c = 0; c < channels; c++) {
        const float normal = (x[c] - s.mean) * s.inverse_deviation;
        dx[c] = s.inverse_deviation * (weight[c] * dy[c] - sum - normal * product);
    }
}

/* Adds one pixel's share to the gradients of weight and bias. */
static void add_shares(const float *x, pixel s, const float *dy, size_t channels, float *dweight, float *dbias)
{
#pragma omp simd
    for (size_t c = 0; c < channels; c++) {
        dweight[c] += dy[c] * ((x[c] - s.mean) * s.inverse_deviation);
        dbias[c] += dy[c];
    }
}

void cpu_layer_norm_backward(const cpu_tensor *x, layer_norm_params params, const cpu_tensor *dy, cpu_tensor *dx,
                             bool accumulate, float *partial, layer_norm_params gradients)
{
    const size_t channels = (size_t)x->c, count = pixel_count(x);
    float *dweights = partial, *dbiases = partial + CPU_PARTS * channels;
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t part = 0; part < CPU_PARTS; part++) {
        float *dweight = dweights + part * channels, *dbias = dbiases + part * channels;
        memset(dweight, 0, channels * sizeof *dweight);
        memset(dbias, 0, channels * sizeof *dbias);
        for (size_t i = count * part / CPU_PARTS; i < count * (part + 1) / CPU_PARTS; i++) {
            float room_x[CPU_MAX_CHANNELS], room_dy[CPU_MAX_CHANNELS], room[CPU_MAX_CHANNELS];
            const float *p = cpu_load(x, i * channels, channels, room_x);
            const float *d = cpu_load(dy, i * channels, channels, room_dy);
            const pixel s = statistics(p, channels);
            add_shares(p, s, d, channels, dweight, dbias);
            if (!dx->data) continue;
            float *q = cpu_target(dx, i * channels, room, accumulate);
            pixel_gradient(p, s, params.weight, d, channels, q);
            cpu_store(dx, i * channels, channels, q, accumulate);
        }
    }
    cpu_sum_parts(dweights, channels, gradients.weight);
    cpu_sum_parts(dbiases, channels, gradients.bias);
}
