/* SPDX-License-Identifier: MIT */
/* Elementwise operations. */
#include "nn/cpu/kernels/kernels.h"

#include <assert.h>

#include "base/number.h"
#include "nn/cpu/kernels/chunk.h"
#include "nn/cpu/kernels/fast_math.h"

/* Coefficients of an elementwise function out[i] = f(a[i], b[i]). */
typedef struct affine {
    float scale, shift;
} affine;
typedef void chunk_function(const float *a, const float *b, float *out, size_t count, affine k);

static void map(const cpu_tensor *a, const cpu_tensor *b, cpu_tensor *out, bool accumulate, chunk_function *f, affine k)
{
    size_t count = cpu_count(out);
#pragma omp parallel for schedule(static) if (count > CPU_PARALLEL_MIN)
    for (size_t at = 0; at < count; at += CPU_CHUNK) {
        float room_a[CPU_CHUNK], room_b[CPU_CHUNK], room_out[CPU_CHUNK];
        size_t n = min_size(CPU_CHUNK, count - at);
        const float *p = cpu_load(a, at, n, room_a);
        const float *q = b ? cpu_load(b, at, n, room_b) : NULL;
        float *r = cpu_target(out, at, room_out, accumulate);
        f(p, q, r, n, k);
        cpu_store(out, at, n, r, accumulate);
    }
}

void cpu_cast(const cpu_tensor *x, cpu_tensor *y, bool accumulate)
{
    size_t count = cpu_count(x);
#pragma omp parallel for schedule(static) if (count > CPU_PARALLEL_MIN)
    for (size_t at = 0; at < count; at += CPU_CHUNK) {
        float room[CPU_CHUNK];
        size_t n = min_size(CPU_CHUNK, count - at);
        cpu_store(y, at, n, cpu_load(x, at, n, room), accumulate);
    }
}

void cpu_zero(cpu_tensor *x)
{
    size_t bytes = cpu_count(x) * cpu_element_size(x), block = 1 << 16;
#pragma omp parallel for schedule(static) if (bytes > 16 * block)
    for (size_t at = 0; at < bytes; at += block)
        memset((char *)x->data + at, 0, min_size(block, bytes - at));
}

/* Computes ReLU. NaN passes, so that a diverged run is visible. */
static void relu(const float *x, const float *unused, float *y, size_t count, affine k)
{
    (void)unused, (void)k;
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        y[i] = x[i] < 0 ? 0 : x[i];
}

void cpu_relu(const cpu_tensor *x, cpu_tensor *y)
{
    map(x, NULL, y, false, relu, (affine){0});
}

static void relu_backward(const float *y, const float *dy, float *dx, size_t count, affine k)
{
    (void)k;
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        dx[i] = y[i] > 0 ? dy[i] : 0;
}

void cpu_relu_backward(const cpu_tensor *y, const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    map(y, dy, dx, accumulate, relu_backward, (affine){0});
}

static void hyperbolic_tangent(const float *x, const float *unused, float *y, size_t count, affine k)
{
    (void)unused, (void)k;
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        y[i] = fast_tanh(x[i]);
}

void cpu_tanh(const cpu_tensor *x, cpu_tensor *y)
{
    map(x, NULL, y, false, hyperbolic_tangent, (affine){0});
}

static void tanh_backward(const float *y, const float *dy, float *dx, size_t count, affine k)
{
    (void)k;
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        dx[i] = dy[i] * (1 - y[i] * y[i]);
}

void cpu_tanh_backward(const cpu_tensor *y, const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    map(y, dy, dx, accumulate, tanh_backward, (affine){0});
}

static void sigmoid(const float *x, const float *unused, float *y, size_t count, affine k)
{
    (void)unused, (void)k;
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        y[i] = fast_sigmoid(x[i]);
}

void cpu_sigmoid(const cpu_tensor *x, cpu_tensor *y)
{
    map(x, NULL, y, false, sigmoid, (affine){0});
}

static void sigmoid_backward(const float *y, const float *dy, float *dx, size_t count, affine k)
{
    (void)k;
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        dx[i] = dy[i] * y[i] * (1 - y[i]);
}

void cpu_sigmoid_backward(const cpu_tensor *y, const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    map(y, dy, dx, accumulate, sigmoid_backward, (affine){0});
}

static void scale_shift(const float *x, const float *unused, float *y, size_t count, affine k)
{
    (void)unused;
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        y[i] = k.scale * x[i] + k.shift;
}

void cpu_scale_shift(const cpu_tensor *x, cpu_tensor *y, float scale, float shift)
{
    map(x, NULL, y, false, scale_shift, (affine){scale, shift});
}

void cpu_scale_shift_backward(const cpu_tensor *dy, cpu_tensor *dx, float scale, bool accumulate)
{
    map(dy, NULL, dx, accumulate, scale_shift, (affine){scale, 0});
}

static void reciprocal(const float *x, const float *unused, float *y, size_t count, affine k)
{
    (void)unused;
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        y[i] = 1 / (k.scale * x[i] + k.shift);
}

void cpu_reciprocal(const cpu_tensor *x, cpu_tensor *y, float scale, float shift)
{
    map(x, NULL, y, false, reciprocal, (affine){scale, shift});
}

static void reciprocal_backward(const float *y, const float *dy, float *dx, size_t count, affine k)
{
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        dx[i] = -k.scale * y[i] * y[i] * dy[i];
}

void cpu_reciprocal_backward(const cpu_tensor *y, const cpu_tensor *dy, cpu_tensor *dx, float scale, bool accumulate)
{
    map(y, dy, dx, accumulate, reciprocal_backward, (affine){scale, 0});
}

static void add(const float *a, const float *b, float *y, size_t count, affine k)
{
    (void)k;
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        y[i] = a[i] + b[i];
}

void cpu_add(const cpu_tensor *a, const cpu_tensor *b, cpu_tensor *y)
{
    assert(b);
    map(a, b, y, false, add, (affine){0});
}
