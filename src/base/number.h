/* SPDX-License-Identifier: MIT */
/* Minimum, maximum, a smooth step that compile to an instruction or two: fminf and fmaxf are calls into the library,
 * because they promise more about NaN than anybody here needs. */
#ifndef MERLIN_BASE_NUMBER_H
#define MERLIN_BASE_NUMBER_H

static inline float min_of(float a, float b)
{
    return a < b ? a : b;
}

static inline float max_of(float a, float b)
{
    return a > b ? a : b;
}

static inline float clamp_to(float low, float high, float x)
{
    return min_of(high, max_of(low, x));
}

/* Smooth 0 to 1 between the edges a < b (Hermite). */
static inline float smooth_step(float a, float b, float x)
{
    float t = clamp_to(0, 1, (x - a) / (b - a));
    return t * t * (3 - 2 * t);
}

/* Compares two floats for qsort. */
static inline int number_ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

#endif
