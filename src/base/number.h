/* SPDX-License-Identifier: MIT */
/* Minimum, maximum, clamp and a smooth step that compile to an instruction or two: fminf and fmaxf are calls into the
 * library, because they promise more about NaN than is needed here. */
#ifndef MERLIN_BASE_NUMBER_H
#define MERLIN_BASE_NUMBER_H

#include <stddef.h>

#include "base/real.h"

static inline real min_of(real a, real b)
{
    return a < b ? a : b;
}

static inline real max_of(real a, real b)
{
    return a > b ? a : b;
}

static inline int min_int(int a, int b)
{
    return a < b ? a : b;
}

/* Limits x to [low, high]. */
static inline int clamp_int(int x, int low, int high)
{
    return x < low ? low : x > high ? high : x;
}

static inline size_t min_size(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Limits x to [low, high]; NaN becomes low. */
static inline real clamp(real x, real low, real high)
{
    return min_of(max_of(x, low), high);
}

/* Rises smoothly from 0 at x = a to 1 at x = b (Hermite); falls where a > b. */
static inline real smooth_step(real a, real b, real x)
{
    real t = clamp((x - a) / (b - a), 0, 1);
    return t * t * (3 - 2 * t);
}

/* Compares two floats for qsort. */
static inline int number_ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

#endif
