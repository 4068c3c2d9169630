/* SPDX-License-Identifier: MIT */
/* Maximum, mean, spread and repetition over an object's pictures. */
#include "nn/cpu/kernels/group.h"

#include <math.h>
#include <string.h>

#include "base/number.h"
#include "nn/cpu/kernels/chunk.h"

/* Below this the variance of pictures is that of their rounding. */
static const float SPREAD_EPSILON = 1e-8f;

/* Numbers of a tensor of pictures: pictures an object, values a picture, chunks into which an image is cut. */
typedef struct extent {
    size_t objects, pictures, size, chunks;
} extent;

static extent extent_of(const cpu_tensor *pictures, const cpu_tensor *objects)
{
    const size_t size = (size_t)objects->h * (size_t)objects->w * (size_t)objects->c;
    return (extent){(size_t)objects->n, (size_t)pictures->n / (size_t)objects->n, size,
                    (size + CPU_CHUNK - 1) / CPU_CHUNK};
}

/* One chunk of an object, at the same place of each of its pictures. */
typedef struct part {
    size_t object, at, count;
} part;

static part part_of(const extent *e, size_t i)
{
    const size_t at = i % e->chunks * CPU_CHUNK;
    return (part){i / e->chunks, at, min_size(CPU_CHUNK, e->size - at)};
}

/* Returns where a picture's chunk begins in its tensor. */
static size_t place(const extent *e, const part *p, size_t picture)
{
    return (p->object * e->pictures + picture) * e->size + p->at;
}

static bool is_present(const cpu_tensor *present, const extent *e, const part *p, size_t picture)
{
    return !present || ((const float *)present->data)[p->object * e->pictures + picture] > 0;
}

static size_t count_present(const cpu_tensor *present, const extent *e, const part *p)
{
    size_t count = 0;
    for (size_t k = 0; k < e->pictures; k++)
        count += is_present(present, e, p, k);
    return count;
}

static void keep_larger(const float *x, float *largest, size_t count)
{
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        largest[i] = x[i] > largest[i] ? x[i] : largest[i];
}

void cpu_group_max(const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y)
{
    const extent e = extent_of(x, y);
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < e.objects * e.chunks; i++) {
        const part p = part_of(&e, i);
        float room[CPU_CHUNK], largest[CPU_CHUNK] = {0};
        bool first = true;
        for (size_t k = 0; k < e.pictures; k++) {
            if (!is_present(present, &e, &p, k)) continue;
            const float *one = cpu_load(x, place(&e, &p, k), p.count, room);
            if (first)
                memcpy(largest, one, p.count * sizeof *one);
            else
                keep_larger(one, largest, p.count);
            first = false;
        }
        cpu_store(y, p.object * e.size + p.at, p.count, largest, false);
    }
}

/* Moves the gradient of values that are the largest to their picture. */
static void take_gradient(const float *x, const float *largest, float *left, float *taken, size_t count)
{
#pragma omp simd
    for (size_t i = 0; i < count; i++) {
        const bool is_largest = x[i] == largest[i];
        taken[i] = is_largest ? left[i] : 0;
        left[i] = is_largest ? 0 : left[i];
    }
}

void cpu_group_max_backward(const cpu_tensor *x, const cpu_tensor *present, const cpu_tensor *y, const cpu_tensor *dy,
                            cpu_tensor *dx, bool accumulate)
{
    const extent e = extent_of(x, y);
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < e.objects * e.chunks; i++) {
        const part p = part_of(&e, i);
        float room_x[CPU_CHUNK], room_y[CPU_CHUNK], room_dy[CPU_CHUNK], left[CPU_CHUNK], taken[CPU_CHUNK];
        const size_t at = p.object * e.size + p.at;
        const float *largest = cpu_load(y, at, p.count, room_y);
        memcpy(left, cpu_load(dy, at, p.count, room_dy), p.count * sizeof *left);
        for (size_t k = 0; k < e.pictures; k++) {
            if (is_present(present, &e, &p, k))
                take_gradient(cpu_load(x, place(&e, &p, k), p.count, room_x), largest, left, taken, p.count);
            else
                memset(taken, 0, sizeof taken);
            cpu_store(dx, place(&e, &p, k), p.count, taken, accumulate);
        }
    }
}

/* Computes the mean of the pictures that are there; returns their number. */
static size_t mean_of(const cpu_tensor *x, const cpu_tensor *present, const extent *e, const part *p, float *mean)
{
    const size_t count = count_present(present, e, p);
    float room[CPU_CHUNK];
    memset(mean, 0, p->count * sizeof *mean);
    for (size_t k = 0; k < e->pictures; k++) {
        if (!is_present(present, e, p, k)) continue;
        const float *one = cpu_load(x, place(e, p, k), p->count, room);
#pragma omp simd
        for (size_t i = 0; i < p->count; i++)
            mean[i] += one[i];
    }
    for (size_t i = 0; count && i < p->count; i++)
        mean[i] /= (float)count;
    return count;
}

void cpu_group_mean(const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y)
{
    const extent e = extent_of(x, y);
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < e.objects * e.chunks; i++) {
        const part p = part_of(&e, i);
        float mean[CPU_CHUNK];
        mean_of(x, present, &e, &p, mean);
        cpu_store(y, p.object * e.size + p.at, p.count, mean, false);
    }
}

void cpu_group_mean_backward(const cpu_tensor *present, const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    const extent e = extent_of(dx, dy);
#pragma omp parallel for schedule(static) if (cpu_count(dx) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < e.objects * e.chunks; i++) {
        const part p = part_of(&e, i);
        const size_t count = count_present(present, &e, &p);
        float room[CPU_CHUNK], share[CPU_CHUNK], none[CPU_CHUNK] = {0};
        const float *gradient = cpu_load(dy, p.object * e.size + p.at, p.count, room);
        for (size_t c = 0; c < p.count; c++)
            share[c] = gradient[c] / (float)(count ? count : 1);
        for (size_t k = 0; k < e.pictures; k++)
            cpu_store(dx, place(&e, &p, k), p.count, is_present(present, &e, &p, k) ? share : none, accumulate);
    }
}

/* Computes mean and spread; returns the number of pictures that are there. */
static size_t spread_of(const cpu_tensor *x, const cpu_tensor *present, const extent *e, const part *p, float *mean,
                        float *spread)
{
    const size_t count = mean_of(x, present, e, p, mean);
    float room[CPU_CHUNK];
    memset(spread, 0, p->count * sizeof *spread);
    for (size_t k = 0; k < e->pictures; k++) {
        if (!is_present(present, e, p, k)) continue;
        const float *one = cpu_load(x, place(e, p, k), p->count, room);
#pragma omp simd
        for (size_t i = 0; i < p->count; i++)
            spread[i] += (one[i] - mean[i]) * (one[i] - mean[i]);
    }
    for (size_t i = 0; count && i < p->count; i++)
        spread[i] = sqrtf(spread[i] / (float)count + SPREAD_EPSILON);
    return count;
}

void cpu_group_spread(const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y)
{
    const extent e = extent_of(x, y);
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < e.objects * e.chunks; i++) {
        const part p = part_of(&e, i);
        float mean[CPU_CHUNK], spread[CPU_CHUNK];
        spread_of(x, present, &e, &p, mean, spread);
        cpu_store(y, p.object * e.size + p.at, p.count, spread, false);
    }
}

void cpu_group_spread_backward(const cpu_tensor *x, const cpu_tensor *present, const cpu_tensor *dy, cpu_tensor *dx,
                               bool accumulate)
{
    const extent e = extent_of(x, dy);
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < e.objects * e.chunks; i++) {
        const part p = part_of(&e, i);
        float mean[CPU_CHUNK], spread[CPU_CHUNK], room[CPU_CHUNK], room_x[CPU_CHUNK], gradient[CPU_CHUNK];
        const size_t count = spread_of(x, present, &e, &p, mean, spread);
        const float *d = cpu_load(dy, p.object * e.size + p.at, p.count, room);
        for (size_t k = 0; k < e.pictures; k++) {
            const bool there = is_present(present, &e, &p, k);
            const float *one = cpu_load(x, place(&e, &p, k), p.count, room_x);
            for (size_t c = 0; c < p.count; c++)
                gradient[c] = there ? d[c] * (one[c] - mean[c]) / ((float)count * spread[c]) : 0;
            cpu_store(dx, place(&e, &p, k), p.count, gradient, accumulate);
        }
    }
}

void cpu_group_repeat(const cpu_tensor *x, cpu_tensor *y)
{
    const extent e = extent_of(y, x);
#pragma omp parallel for schedule(static) if (cpu_count(y) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < e.objects * e.chunks; i++) {
        const part p = part_of(&e, i);
        float room[CPU_CHUNK];
        const float *one = cpu_load(x, p.object * e.size + p.at, p.count, room);
        for (size_t k = 0; k < e.pictures; k++)
            cpu_store(y, place(&e, &p, k), p.count, one, false);
    }
}

void cpu_group_repeat_backward(const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    const extent e = extent_of(dy, dx);
#pragma omp parallel for schedule(static) if (cpu_count(dy) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < e.objects * e.chunks; i++) {
        const part p = part_of(&e, i);
        float room[CPU_CHUNK], sum[CPU_CHUNK] = {0};
        for (size_t k = 0; k < e.pictures; k++) {
            const float *one = cpu_load(dy, place(&e, &p, k), p.count, room);
#pragma omp simd
            for (size_t c = 0; c < p.count; c++)
                sum[c] += one[c];
        }
        cpu_store(dx, p.object * e.size + p.at, p.count, sum, accumulate);
    }
}
