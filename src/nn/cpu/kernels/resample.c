/* SPDX-License-Identifier: MIT */
/* Upsampling to twice the size, and its exact adjoint. */
#include "nn/cpu/kernels/kernels.h"

#include <assert.h>

#include "base/number.h"
#include "nn/cpu/kernels/chunk.h"

/* Floats of a tile of columns. A row is processed in tiles whose buffers fit the first-level cache; with a neighbour on
 * either side a tile of the smaller image has at most this many. */
enum { COLUMNS = CPU_CHUNK + 2 * CPU_MAX_CHANNELS };

static size_t tile_pixels(size_t channels)
{
    return channels >= CPU_CHUNK ? 1 : CPU_CHUNK / channels;
}

/* Computes v[1 .. n], the tile's columns of output row `row` interpolated between input rows; v[0] and v[n + 1] are the
 * neighbours, or the edge again. */
static void mix_rows(const cpu_tensor *x, size_t row, size_t at, size_t n, float *v)
{
    size_t channels = (size_t)x->c, width = (size_t)x->w, height = (size_t)x->h;
    size_t sample = row / (2 * height), r = row % (2 * height), near = r / 2;
    size_t far = r % 2 ? (near + 1 < height ? near + 1 : near) : (near > 0 ? near - 1 : near);
    size_t first = at > 0 ? at - 1 : 0, last = at + n < width ? at + n : width - 1;
    size_t count = (last - first + 1) * channels;
    float room_near[COLUMNS], room_far[COLUMNS];
    const float *p = cpu_load(x, ((sample * height + near) * width + first) * channels, count, room_near);
    const float *q = cpu_load(x, ((sample * height + far) * width + first) * channels, count, room_far);
    float *to = v + (at > 0 ? 0 : channels);
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        to[i] = 0.75f * p[i] + 0.25f * q[i];
    if (at == 0) memcpy(v, v + channels, channels * sizeof *v);
    if (at + n == width) memcpy(v + (n + 1) * channels, v + n * channels, channels * sizeof *v);
}

static void mix_columns(const float *v, float *out, size_t n, size_t channels)
{
    for (size_t i = 0; i < n; i++) {
        const float *left = v + i * channels, *middle = left + channels, *right = middle + channels;
        float *even = out + 2 * i * channels, *odd = even + channels;
#pragma omp simd
        for (size_t c = 0; c < channels; c++) {
            float m = 0.75f * middle[c];
            even[c] = m + 0.25f * left[c];
            odd[c] = m + 0.25f * right[c];
        }
    }
}

void cpu_upsample_bilinear(const cpu_tensor *x, cpu_tensor *y)
{
    size_t channels = (size_t)x->c, width = (size_t)x->w, rows = (size_t)y->n * (size_t)y->h;
    size_t step = tile_pixels(channels);
    assert(x->c <= CPU_MAX_CHANNELS);
#pragma omp parallel for schedule(static) if (cpu_count(y) > CPU_PARALLEL_MIN)
    for (size_t row = 0; row < rows; row++)
        for (size_t at = 0; at < width; at += step) {
            float v[COLUMNS], room[2 * COLUMNS];
            size_t n = min_size(step, width - at), to = 2 * (row * width + at) * channels;
            mix_rows(x, row, at, n, v);
            float *out = cpu_target(y, to, room, false);
            mix_columns(v, out, n, channels);
            cpu_store(y, to, 2 * n * channels, out, false);
        }
}

/* Weights with which input line i of `size` reaches output lines 2i - 1 .. 2i + 2. At the edges, where a line is its
 * own neighbour, the weight of the line that falls outside goes to the one beside it. */
typedef struct reach {
    float weight[4];
} reach;

static reach reach_of(size_t i, size_t size)
{
    reach r = {{0.25f, 0.75f, 0.75f, 0.25f}};
    if (i == 0) r.weight[0] = 0, r.weight[1] = 1;
    if (i == size - 1) r.weight[3] = 0, r.weight[2] = 1;
    return r;
}

/* Computes v, the weighted sum of the output rows that input row `row` reached: output columns 2at - 1 .. 2(at + n), of
 * which those outside the image stay zero. */
static void gather_rows(const cpu_tensor *dy, size_t row, size_t at, size_t n, float *v)
{
    size_t channels = (size_t)dy->c, width = (size_t)dy->w, height = (size_t)dy->h / 2;
    size_t sample = row / height, i = row % height;
    size_t first = at > 0 ? 2 * at - 1 : 0, last = min_size(2 * (at + n), width - 1);
    size_t count = (last - first + 1) * channels;
    reach r = reach_of(i, height);
    memset(v, 0, (2 * n + 2) * channels * sizeof *v);
    float *to = v + (at > 0 ? 0 : channels), room[2 * COLUMNS];
    for (size_t k = 0; k < 4; k++) {
        float weight = r.weight[k];
        if (weight == 0) continue;
        size_t line = sample * 2 * height + 2 * i + k - 1;
        const float *p = cpu_load(dy, (line * width + first) * channels, count, room);
#pragma omp simd
        for (size_t j = 0; j < count; j++)
            to[j] += weight * p[j];
    }
}

static void gather_columns(const float *v, float *out, size_t at, size_t n, size_t width, size_t channels)
{
    for (size_t i = 0; i < n; i++) {
        reach r = reach_of(at + i, width);
        const float *p = v + 2 * i * channels;
        float *q = out + i * channels;
#pragma omp simd
        for (size_t c = 0; c < channels; c++)
            q[c] = (r.weight[0] * p[c] + r.weight[1] * p[channels + c]) +
                   (r.weight[2] * p[2 * channels + c] + r.weight[3] * p[3 * channels + c]);
    }
}

void cpu_upsample_bilinear_backward(const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    size_t channels = (size_t)dx->c, width = (size_t)dx->w, rows = (size_t)dx->n * (size_t)dx->h;
    size_t step = tile_pixels(channels);
    assert(dx->c <= CPU_MAX_CHANNELS);
#pragma omp parallel for schedule(static) if (cpu_count(dy) > CPU_PARALLEL_MIN)
    for (size_t row = 0; row < rows; row++)
        for (size_t at = 0; at < width; at += step) {
            float v[2 * COLUMNS], room[COLUMNS];
            size_t n = min_size(step, width - at), to = (row * width + at) * channels;
            gather_rows(dy, row, at, n, v);
            float *q = cpu_target(dx, to, room, accumulate);
            gather_columns(v, q, at, n, width, channels);
            cpu_store(dx, to, n * channels, q, accumulate);
        }
}
