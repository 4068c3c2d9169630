/* SPDX-License-Identifier: MIT */
/* Tensors as runs of floats: the kernels of this folder are written once, on float32 chunks that fit the first-level
 * cache, whatever type the tensor has in memory.
 *
 *     float room_x[CPU_CHUNK], room_y[CPU_CHUNK];
 *     const float *p = cpu_load(x, at, count, room_x);
 *     float *q = cpu_target(y, at, room_y, accumulate);
 *     for (size_t i = 0; i < count; i++) q[i] = f(p[i]);
 *     cpu_store(y, at, count, q, accumulate);
 *
 * A float32 tensor is read and written in place; only bfloat16 and accumulation go through the buffers. */
#ifndef MERLIN_NN_CPU_KERNELS_CHUNK_H
#define MERLIN_NN_CPU_KERNELS_CHUNK_H

#include <string.h>

#include "base/half.h"
#include "nn/cpu/kernels/kernels.h"

enum {
    CPU_CHUNK = 1024,         /* elements; three or four such buffers fit the first-level cache */
    CPU_PARALLEL_MIN = 16384, /* below this many elements, waking a second thread costs more than it saves */
    CPU_PARTS = 64, /* parts whose sums are added in their order, so that a sum does not depend on the threads */
};

/* Computes the sums of CPU_PARTS rows of so many numbers. */
static inline void cpu_sum_parts(const float *parts, size_t count, float *sum)
{
    for (size_t i = 0; i < count; i++) {
        double total = 0;
        for (size_t part = 0; part < CPU_PARTS; part++)
            total += (double)parts[part * count + i];
        sum[i] = (float)total;
    }
}

static inline size_t cpu_element_size(const cpu_tensor *t)
{
    return t->type == NN_FLOAT32 ? sizeof(float) : sizeof(uint16_t);
}

/* Returns elements [at, at + count) as floats: in place, or converted into buffer. */
static inline const float *cpu_load(const cpu_tensor *t, size_t at, size_t count, float *buffer)
{
    if (t->type == NN_FLOAT32) return (const float *)t->data + at;
    const uint16_t *from = (const uint16_t *)t->data + at;
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        buffer[i] = bf16_to_float(from[i]);
    return buffer;
}

/* Returns where to compute the values that cpu_store will put at element `at`. */
static inline float *cpu_target(const cpu_tensor *t, size_t at, float *buffer, bool accumulate)
{
    return t->type == NN_FLOAT32 && !accumulate ? (float *)t->data + at : buffer;
}

static inline void cpu_store_bf16(uint16_t *to, size_t count, const float *values, bool accumulate)
{
    if (accumulate) {
#pragma omp simd
        for (size_t i = 0; i < count; i++)
            to[i] = float_to_bf16(bf16_to_float(to[i]) + values[i]);
    } else {
#pragma omp simd
        for (size_t i = 0; i < count; i++)
            to[i] = float_to_bf16(values[i]);
    }
}

static inline void cpu_store(cpu_tensor *t, size_t at, size_t count, const float *values, bool accumulate)
{
    if (t->type == NN_BFLOAT16) {
        cpu_store_bf16((uint16_t *)t->data + at, count, values, accumulate);
        return;
    }
    float *to = (float *)t->data + at;
    if (accumulate) {
#pragma omp simd
        for (size_t i = 0; i < count; i++)
            to[i] += values[i];
    } else if (to != values) {
        memcpy(to, values, count * sizeof *to);
    }
}

#endif
