/* SPDX-License-Identifier: MIT */
/* Copies of short runs of equal length at equal strides: concatenation, slicing and block rearrangements are made of
 * them. */
#ifndef MERLIN_NN_CPU_KERNELS_RUNS_H
#define MERLIN_NN_CPU_KERNELS_RUNS_H

#include "base/inline.h"
#include "base/number.h"
#include "nn/cpu/kernels/chunk.h"

typedef struct run_copy { /* all in elements */
    size_t run, from_stride, to_stride, count;
    bool accumulate;
} run_copy;

static inline void copy_bytes(const char *from, size_t from_stride, char *to, size_t to_stride, size_t bytes,
                              size_t count)
{
    for (size_t i = 0; i < count; i++)
        memcpy(to + i * to_stride, from + i * from_stride, bytes);
}

/* Adds instead of copying; inlined so that a constant run becomes a few additions. */
ALWAYS_INLINE void add_floats(const float *from, float *to, const run_copy *copy, size_t run)
{
    for (size_t i = 0; i < copy->count; i++)
        for (size_t c = 0; c < run; c++)
            to[i * copy->to_stride + c] += from[i * copy->from_stride + c];
}

static inline void add_float_runs(const float *from, float *to, const run_copy *copy)
{
    switch (copy->run) {
    case 1:
        add_floats(from, to, copy, 1);
        break;
    case 3:
        add_floats(from, to, copy, 3);
        break;
    default:
        add_floats(from, to, copy, copy->run);
    }
}

/* Copies the runs of `copy` from element `from_at` of x to element `to_at` of y. */
static inline void copy_runs(const cpu_tensor *x, size_t from_at, cpu_tensor *y, size_t to_at, const run_copy *copy)
{
    if (copy->accumulate && x->type == NN_FLOAT32 && y->type == NN_FLOAT32) {
        add_float_runs((const float *)x->data + from_at, (float *)y->data + to_at, copy);
        return;
    }
    if (copy->accumulate) {
        float room[CPU_CHUNK];
        for (size_t i = 0; i < copy->count; i++)
            for (size_t c = 0; c < copy->run; c += CPU_CHUNK) {
                size_t n = min_size(CPU_CHUNK, copy->run - c);
                const float *p = cpu_load(x, from_at + i * copy->from_stride + c, n, room);
                cpu_store(y, to_at + i * copy->to_stride + c, n, p, true);
            }
        return;
    }
    size_t size = cpu_element_size(x), from_stride = copy->from_stride * size, to_stride = copy->to_stride * size;
    const char *from = (const char *)x->data + from_at * size;
    char *to = (char *)y->data + to_at * size;
    /* with a constant length memcpy becomes one or two moves, which matters for the few channels of maps */
    switch (copy->run * size) {
    case 2:
        copy_bytes(from, from_stride, to, to_stride, 2, copy->count);
        break;
    case 4:
        copy_bytes(from, from_stride, to, to_stride, 4, copy->count);
        break;
    case 8:
        copy_bytes(from, from_stride, to, to_stride, 8, copy->count);
        break;
    case 12:
        copy_bytes(from, from_stride, to, to_stride, 12, copy->count);
        break;
    case 16:
        copy_bytes(from, from_stride, to, to_stride, 16, copy->count);
        break;
    case 32:
        copy_bytes(from, from_stride, to, to_stride, 32, copy->count);
        break;
    case 64:
        copy_bytes(from, from_stride, to, to_stride, 64, copy->count);
        break;
    default:
        copy_bytes(from, from_stride, to, to_stride, copy->run * size, copy->count);
    }
}

#endif
