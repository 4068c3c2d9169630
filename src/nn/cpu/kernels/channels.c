/* SPDX-License-Identifier: MIT */
/* Operations that select, repeat, weight or sum whole pixels: runs of channels. */
#include "nn/cpu/kernels/kernels.h"

#include <assert.h>
#include <math.h>

#include "base/number.h"
#include "nn/cpu/kernels/chunk.h"
#include "nn/cpu/kernels/runs.h"

static size_t pixel_count(const cpu_tensor *t)
{
    return (size_t)t->n * (size_t)t->h * (size_t)t->w;
}

/* Returns the number of pixels whose channels fill about a chunk. */
static size_t pixels_per_tile(const cpu_tensor *t)
{
    assert(t->c <= CPU_MAX_CHANNELS);
    return t->c >= CPU_CHUNK ? 1 : (size_t)(CPU_CHUNK / t->c);
}

enum { TILE = CPU_MAX_CHANNELS };
_Static_assert(TILE >= (int)CPU_CHUNK, "a tile holds a chunk of narrow pixels or one wide pixel");

void cpu_insert_channels(const cpu_tensor *x, cpu_tensor *y, int first, bool accumulate)
{
    run_copy copy = {.run = (size_t)x->c,
                     .from_stride = (size_t)x->c,
                     .to_stride = (size_t)y->c,
                     .count = (size_t)x->w,
                     .accumulate = accumulate};
    size_t rows = (size_t)x->n * (size_t)x->h;
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t row = 0; row < rows; row++) {
        size_t from = row * (size_t)x->w * (size_t)x->c, to = row * (size_t)y->w * (size_t)y->c + (size_t)first;
        copy_runs(x, from, y, to, &copy);
    }
}

void cpu_extract_channels(const cpu_tensor *y, int first, cpu_tensor *x, bool accumulate)
{
    run_copy copy = {.run = (size_t)x->c,
                     .from_stride = (size_t)y->c,
                     .to_stride = (size_t)x->c,
                     .count = (size_t)x->w,
                     .accumulate = accumulate};
    size_t rows = (size_t)x->n * (size_t)x->h;
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t row = 0; row < rows; row++) {
        size_t from = row * (size_t)y->w * (size_t)y->c + (size_t)first, to = row * (size_t)x->w * (size_t)x->c;
        copy_runs(y, from, x, to, &copy);
    }
}

void cpu_space_to_depth(const cpu_tensor *x, cpu_tensor *y, int block, bool accumulate)
{
    size_t run = (size_t)block * (size_t)x->c, height = (size_t)y->h, b = (size_t)block;
    run_copy copy = {
        .run = run, .from_stride = run, .to_stride = (size_t)y->c, .count = (size_t)y->w, .accumulate = accumulate};
    size_t rows = (size_t)y->n * height;
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t row = 0; row < rows; row++)
        for (size_t r = 0; r < b; r++) {
            size_t from = (row * b + r) * (size_t)x->w * (size_t)x->c;
            copy_runs(x, from, y, row * (size_t)y->w * (size_t)y->c + r * run, &copy);
        }
}

void cpu_depth_to_space(const cpu_tensor *x, cpu_tensor *y, int block, bool accumulate)
{
    size_t run = (size_t)block * (size_t)y->c, height = (size_t)x->h, b = (size_t)block;
    run_copy copy = {
        .run = run, .from_stride = (size_t)x->c, .to_stride = run, .count = (size_t)x->w, .accumulate = accumulate};
    size_t rows = (size_t)x->n * height;
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t row = 0; row < rows; row++)
        for (size_t r = 0; r < b; r++) {
            size_t to = (row * b + r) * (size_t)y->w * (size_t)y->c;
            copy_runs(x, row * (size_t)x->w * (size_t)x->c + r * run, y, to, &copy);
        }
}

void cpu_tile(const cpu_tensor *x, cpu_tensor *y)
{
    size_t bytes = (size_t)x->c * cpu_element_size(x), width = (size_t)y->w;
    size_t rows = (size_t)y->n * (size_t)y->h;
#pragma omp parallel for schedule(static) if (cpu_count(y) > CPU_PARALLEL_MIN)
    for (size_t row = 0; row < rows; row++) {
        const char *from = (const char *)x->data + row / (size_t)y->h * bytes;
        char *to = (char *)y->data + row * width * bytes;
        for (size_t i = 0; i < width; i++)
            memcpy(to + i * bytes, from, bytes);
    }
}

/* Adds a row's pixels: sum[c] += Σ, in float within the row and in double between rows. */
static void sum_row(const cpu_tensor *t, size_t row, double *sum)
{
    size_t channels = (size_t)t->c, width = (size_t)t->w;
    float room[CPU_MAX_CHANNELS], partial[CPU_MAX_CHANNELS];
    memset(partial, 0, channels * sizeof *partial);
    for (size_t i = 0; i < width; i++) {
        const float *p = cpu_load(t, (row * width + i) * channels, channels, room);
        for (size_t c = 0; c < channels; c++)
            partial[c] += p[c];
    }
    for (size_t c = 0; c < channels; c++)
        sum[c] += partial[c];
}

/* Computes to = scale times the sum of from's pixels, one image at a time. */
static void sum_images(const cpu_tensor *from, cpu_tensor *to, double scale, bool accumulate)
{
    size_t channels = (size_t)to->c, height = (size_t)from->h, batch = (size_t)from->n;
    assert(to->c <= CPU_MAX_CHANNELS);
#pragma omp parallel for schedule(static) if (cpu_count(from) > CPU_PARALLEL_MIN)
    for (size_t n = 0; n < batch; n++) {
        double sum[CPU_MAX_CHANNELS] = {0};
        float total[CPU_MAX_CHANNELS];
        for (size_t y = 0; y < height; y++)
            sum_row(from, n * height + y, sum);
        for (size_t c = 0; c < channels; c++)
            total[c] = (float)(scale * sum[c]);
        cpu_store(to, n * channels, channels, total, accumulate);
    }
}

void cpu_tile_backward(const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    sum_images(dy, dx, 1, accumulate);
}

void cpu_spatial_mean(const cpu_tensor *x, cpu_tensor *y)
{
    sum_images(x, y, 1 / ((double)x->h * (double)x->w), false);
}

void cpu_spatial_mean_backward(const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    size_t channels = (size_t)dx->c, area = (size_t)dx->h * (size_t)dx->w, pixels = (size_t)dx->n * area;
    assert(dx->c <= CPU_MAX_CHANNELS);
#pragma omp parallel for schedule(static) if (cpu_count(dx) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < pixels; i++) {
        float room[CPU_MAX_CHANNELS], share[CPU_MAX_CHANNELS];
        const float *p = cpu_load(dy, i / area * channels, channels, room);
        for (size_t c = 0; c < channels; c++)
            share[c] = p[c] / (float)area;
        cpu_store(dx, i * channels, channels, share, accumulate);
    }
}

/* Computes q[i, c] = p[i, c]·gate[i]. */
static void weigh(const float *p, const float *gate, float *q, size_t pixels, size_t channels)
{
    for (size_t i = 0; i < pixels; i++) {
        float g = gate[i];
#pragma omp simd
        for (size_t c = 0; c < channels; c++)
            q[i * channels + c] = p[i * channels + c] * g;
    }
}

static void dot(const float *p, const float *q, float *out, size_t pixels, size_t channels)
{
    for (size_t i = 0; i < pixels; i++) {
        float sum = 0;
#pragma omp simd reduction(+ : sum)
        for (size_t c = 0; c < channels; c++)
            sum += p[i * channels + c] * q[i * channels + c];
        out[i] = sum;
    }
}

void cpu_gate(const cpu_tensor *x, const cpu_tensor *gate, cpu_tensor *y)
{
    size_t pixels = pixel_count(x), channels = (size_t)x->c, step = pixels_per_tile(x);
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t at = 0; at < pixels; at += step) {
        float room_x[TILE], room_gate[TILE], room_y[TILE];
        size_t n = min_size(step, pixels - at);
        const float *p = cpu_load(x, at * channels, n * channels, room_x), *g = cpu_load(gate, at, n, room_gate);
        float *q = cpu_target(y, at * channels, room_y, false);
        weigh(p, g, q, n, channels);
        cpu_store(y, at * channels, n * channels, q, false);
    }
}

/* Writes the inputs' gradients in their order: where an input is its own gate there is one gradient, written first and
 * then added to. */
void cpu_gate_backward(const cpu_tensor *x, const cpu_tensor *gate, const cpu_tensor *dy, cpu_tensor *dx,
                       bool accumulate_x, cpu_tensor *dgate, bool accumulate_gate)
{
    size_t pixels = pixel_count(x), channels = (size_t)x->c, step = pixels_per_tile(x);
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t at = 0; at < pixels; at += step) {
        float room_x[TILE], room_dy[TILE], room_gate[TILE], room_out[TILE];
        size_t n = min_size(step, pixels - at);
        const float *d = cpu_load(dy, at * channels, n * channels, room_dy);
        if (dx && dx->data) {
            float *out = cpu_target(dx, at * channels, room_out, accumulate_x);
            weigh(d, cpu_load(gate, at, n, room_gate), out, n, channels);
            cpu_store(dx, at * channels, n * channels, out, accumulate_x);
        }
        if (dgate && dgate->data) {
            float *out = cpu_target(dgate, at, room_out, accumulate_gate);
            dot(cpu_load(x, at * channels, n * channels, room_x), d, out, n, channels);
            cpu_store(dgate, at, n, out, accumulate_gate);
        }
    }
}

/* Shortest vector that is normalized; shorter ones are divided by this length, and pass no gradient. */
static const float shortest = 1e-6f;

static inline float length(const float *x, size_t channels)
{
    float sum = 0;
    for (size_t c = 0; c < channels; c++)
        sum += x[c] * x[c];
    return sqrtf(sum);
}

static inline void normalize(const float *x, float *y, size_t pixels, size_t channels)
{
    for (size_t i = 0; i < pixels; i++) {
        float l = length(x + i * channels, channels), scale = 1 / (l < shortest ? shortest : l);
        for (size_t c = 0; c < channels; c++)
            y[i * channels + c] = x[i * channels + c] * scale;
    }
}

void cpu_normalize(const cpu_tensor *x, cpu_tensor *y)
{
    size_t rows = (size_t)x->n * (size_t)x->h, width = (size_t)x->w, channels = (size_t)x->c;
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t row = 0; row < rows; row++) {
        const float *p = (const float *)x->data + row * width * channels;
        float *q = (float *)y->data + row * width * channels;
        /* normals have 3 channels: with a constant count the compiler unrolls the loop */
        if (channels == 3)
            normalize(p, q, width, 3);
        else
            normalize(p, q, width, channels);
    }
}

typedef struct normalize_gradient {
    const float *x, *y, *dy;
    float *dx;
    bool accumulate;
} normalize_gradient;

/* Computes the gradient of x/|x|: the part of dy perpendicular to y, divided by the length. */
static inline void normalize_backward(const normalize_gradient *g, size_t pixels, size_t channels)
{
    for (size_t i = 0; i < pixels; i++) {
        const float *y = g->y + i * channels, *dy = g->dy + i * channels;
        float *dx = g->dx + i * channels;
        float l = length(g->x + i * channels, channels), scale = l < shortest ? 0 : 1 / l, along = 0;
        for (size_t c = 0; c < channels; c++)
            along += y[c] * dy[c];
        for (size_t c = 0; c < channels; c++) {
            float before = g->accumulate ? dx[c] : 0;
            dx[c] = before + (dy[c] - y[c] * along) * scale;
        }
    }
}

void cpu_normalize_backward(const cpu_tensor *x, const cpu_tensor *y, const cpu_tensor *dy, cpu_tensor *dx,
                            bool accumulate)
{
    size_t rows = (size_t)x->n * (size_t)x->h, width = (size_t)x->w, channels = (size_t)x->c;
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t row = 0; row < rows; row++) {
        size_t at = row * width * channels;
        normalize_gradient g = {(const float *)x->data + at, (const float *)y->data + at, (const float *)dy->data + at,
                                (float *)dx->data + at, accumulate};
        if (channels == 3)
            normalize_backward(&g, width, 3);
        else
            normalize_backward(&g, width, channels);
    }
}
