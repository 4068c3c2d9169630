/* SPDX-License-Identifier: MIT */
/* Vectors in double precision, for sums and derivatives in which vec3's rounding would show. */
#ifndef MERLIN_STEREO_ALGEBRA_EXACT3_H
#define MERLIN_STEREO_ALGEBRA_EXACT3_H

#include <math.h>

#include "base/vec.h"

typedef struct exact3 {
    double x, y, z;
} exact3;

static inline exact3 exact3_of(vec3 v)
{
    return (exact3){(double)v.x, (double)v.y, (double)v.z};
}

static inline exact3 exact3_sub(exact3 a, exact3 b)
{
    return (exact3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline exact3 exact3_scale(exact3 a, double by)
{
    return (exact3){a.x * by, a.y * by, a.z * by};
}

static inline double exact3_dot(exact3 a, exact3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline double exact3_length(exact3 a)
{
    return sqrt(exact3_dot(a, a));
}

/* Returns a / |a|; the zero vector stays zero. */
static inline exact3 exact3_normalize(exact3 a)
{
    const double length = exact3_length(a);
    return length > 0 ? exact3_scale(a, 1 / length) : a;
}

/* Multiplies by a row-major matrix. */
static inline exact3 exact3_transform(const double m[9], exact3 v)
{
    return (exact3){m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
                    m[6] * v.x + m[7] * v.y + m[8] * v.z};
}

#endif
