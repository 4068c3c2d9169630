/* SPDX-License-Identifier: MIT */
/* Reference vectors that PyTorch made: inputs and parameters are numbers that both sides compute from names
 * (tests/reference/numbers_by_name.py), results are in a safetensors file. */
#ifndef MERLIN_TESTS_REFERENCE_H
#define MERLIN_TESTS_REFERENCE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "nn/nn.h"
#include "nn/safetensors.h"

#include <cmocka.h>

static inline uint32_t reference_hash(const char *name)
{
    uint32_t h = 2166136261u;
    for (; *name; name++)
        h = (h ^ (unsigned char)*name) * 16777619u;
    return h;
}

/* Returns a number in [-1, 1). */
static inline double reference_number(uint32_t seed, size_t i)
{
    uint32_t x = seed + (uint32_t)i * 0x9e3779b9u;
    x ^= x >> 16;
    x *= 0x85ebca6bu;
    x ^= x >> 13;
    x *= 0xc2b2ae35u;
    x ^= x >> 16;
    return (double)(x >> 8) * 0x1p-23 - 1;
}

static inline void reference_fill(float *to, const char *name, size_t count, double scale, double shift)
{
    uint32_t seed = reference_hash(name);
    for (size_t i = 0; i < count; i++)
        to[i] = (float)(scale * reference_number(seed, i) + shift);
}

static inline bool reference_ends_in(const char *name, const char *ending)
{
    size_t n = strlen(name), m = strlen(ending);
    return n >= m && strcmp(name + n - m, ending) == 0;
}

static inline void reference_fill_params(nn_params *params)
{
    for (size_t i = 0; i < nn_params_count(params); i++) {
        nn_param *p = nn_params_at(params, i);
        double fan_in = (double)p->count / (double)p->shape[0], scale = p->rank > 1 ? sqrt(6 / fan_in) : 0.2;
        bool around_one = reference_ends_in(p->name, ".running_var") || reference_ends_in(p->name, "norm.weight");
        reference_fill(p->value, p->name, p->count, scale, around_one ? 1 : 0);
    }
    nn_params_touch(params);
}

static inline const safetensors_tensor *reference_stored(const safetensors_file *f, const char *kind, const char *name)
{
    char full[160];
    snprintf(full, sizeof full, "%s.%s", kind, name);
    return safetensors_find(f, full);
}

/* Returns |found - expected| over |expected|, as vectors. */
static inline double reference_distance(const safetensors_tensor *expected, const float *found)
{
    float *wanted = malloc((expected->count + 1) * sizeof *wanted);
    assert_non_null(wanted);
    assert_int_equal(safetensors_to_float(expected, wanted), OK);
    double error = 0, size = 0;
    for (size_t i = 0; i < expected->count; i++) {
        error += pow((double)found[i] - (double)wanted[i], 2);
        size += pow((double)wanted[i], 2);
    }
    free(wanted);
    return sqrt(error / (size + 1e-30));
}

static inline void reference_compare(const safetensors_file *f, const char *kind, const char *name, const float *found,
                                     double tolerance)
{
    const safetensors_tensor *t = reference_stored(f, kind, name);
    if (!t) fail_msg("%s.%s is not in the reference", kind, name);
    double d = reference_distance(t, found);
    if (!(d <= tolerance)) fail_msg("%s.%s is off by %.3g of its size, %.3g allowed", kind, name, d, tolerance);
}

/* Fills pictures of size × size with a disc of 1. */
static inline void reference_fill_disc(float *to, int pictures, int size, int radius)
{
    for (int i = 0; i < pictures * size * size; i++) {
        const int x = 2 * (i % size) + 1 - size, y = 2 * (i / size % size) + 1 - size;
        to[i] = x * x + y * y < 4 * radius * radius ? 1 : 0;
    }
}

/* Compares an output of size × size pixels, of which the reference has every step-th of every step-th row; neither may
 * have it alone. */
static inline void reference_compare_output(const safetensors_file *f, const char *kind, const char *name,
                                            const float *found, int size, int step, double tolerance)
{
    const safetensors_tensor *t = reference_stored(f, kind, name);
    assert_true((t == NULL) == (found == NULL));
    if (!t) return;
    const size_t channels = (size_t)t->shape[3], pixels = t->count / channels, side = (size_t)(size / step);
    float *kept = malloc(t->count * sizeof *kept);
    assert_non_null(kept);
    for (size_t i = 0; i < pixels; i++) {
        const size_t n = i / (side * side), y = i / side % side * (size_t)step, x = i % side * (size_t)step;
        const size_t at = (n * (size_t)size + y) * (size_t)size + x;
        memcpy(kept + i * channels, found + at * channels, channels * sizeof *kept);
    }
    reference_compare(f, kind, name, kept, tolerance);
    free(kept);
}

#endif
