/* SPDX-License-Identifier: MIT */
/* Tensors for the tests of kernels: allocating, filling, reading as doubles, comparing. */
#ifndef MERLIN_TESTS_TENSORS_H
#define MERLIN_TESTS_TENSORS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "base/threads.h"
#include "nn/cpu/kernels/kernels.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

/* Relative error of rounding to nearest: half a unit in the last place; bfloat16 has 8 significant bits. */
#define BF16_ROUNDING 0x1p-8

static inline size_t tensor_bytes_of(const cpu_tensor *t)
{
    return cpu_count(t) * (t->type == NN_FLOAT32 ? sizeof(float) : sizeof(uint16_t));
}

static inline double tensor_get(const cpu_tensor *t, size_t i)
{
    return (double)(t->type == NN_FLOAT32 ? ((float *)t->data)[i] : bf16_to_float(((uint16_t *)t->data)[i]));
}

static inline void tensor_set(cpu_tensor *t, size_t i, double value)
{
    if (t->type == NN_FLOAT32)
        ((float *)t->data)[i] = (float)value;
    else
        ((uint16_t *)t->data)[i] = float_to_bf16((float)value);
}

static inline size_t tensor_index(const cpu_tensor *t, int n, int y, int x, int c)
{
    return (((size_t)n * (size_t)t->h + (size_t)y) * (size_t)t->w + (size_t)x) * (size_t)t->c + (size_t)c;
}

static inline double tensor_at(const cpu_tensor *t, int n, int y, int x, int c)
{
    return tensor_get(t, tensor_index(t, n, y, x, c));
}

static inline cpu_tensor tensor_new(nn_type type, int n, int h, int w, int c)
{
    cpu_tensor t = {NULL, type, n, h, w, c};
    t.data = calloc(1, tensor_bytes_of(&t) + 1);
    assert_non_null(t.data);
    return t;
}

/* Fills with numbers uniform in [low, high). */
static inline void tensor_fill(cpu_tensor *t, uint64_t seed, float low, float high)
{
    rng r = rng_at(seed, 0, 0);
    for (size_t i = 0; i < cpu_count(t); i++)
        tensor_set(t, i, (double)rng_range(&r, low, high));
}

static inline cpu_tensor tensor_random(nn_type type, int n, int h, int w, int c, uint64_t seed)
{
    cpu_tensor t = tensor_new(type, n, h, w, c);
    tensor_fill(&t, seed, -1, 1);
    return t;
}

static inline cpu_tensor tensor_like(const cpu_tensor *t)
{
    return tensor_new(t->type, t->n, t->h, t->w, t->c);
}

static inline cpu_tensor tensor_converted(const cpu_tensor *t, nn_type type)
{
    cpu_tensor out = tensor_new(type, t->n, t->h, t->w, t->c);
    for (size_t i = 0; i < cpu_count(t); i++)
        tensor_set(&out, i, tensor_get(t, i));
    return out;
}

static inline void tensor_free(cpu_tensor *t)
{
    free(t->data);
    t->data = NULL;
}

static inline double tensor_dot(const cpu_tensor *a, const cpu_tensor *b)
{
    double sum = 0;
    for (size_t i = 0; i < cpu_count(a); i++)
        sum += tensor_get(a, i) * tensor_get(b, i);
    return sum;
}

/* Asserts |a - expected| <= relative |expected| + absolute, everywhere. */
static inline void assert_near(const char *what, const cpu_tensor *a, const cpu_tensor *expected, double relative,
                               double absolute)
{
    for (size_t i = 0; i < cpu_count(a); i++) {
        double found = tensor_get(a, i), wanted = tensor_get(expected, i);
        if (fabs(found - wanted) <= relative * fabs(wanted) + absolute) continue;
        fail_msg("%s: element %zu of %zu is %.9g, expected %.9g", what, i, cpu_count(a), found, wanted);
    }
}

static inline void assert_same_bits(const char *what, const cpu_tensor *a, const cpu_tensor *b)
{
    if (memcmp(a->data, b->data, tensor_bytes_of(a)) != 0) fail_msg("%s: different bits", what);
}

/* Returns the rounding error of a result in this type, in addition to float32's after a handful of operations. */
static inline double tensor_rounding(nn_type type)
{
    return type == NN_FLOAT32 ? 1e-6 : BF16_ROUNDING + 1e-6;
}

#endif
