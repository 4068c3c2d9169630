/* SPDX-License-Identifier: MIT */
/* Small vectors. */
#ifndef MERLIN_BASE_VEC_H
#define MERLIN_BASE_VEC_H

#include <tgmath.h>

#include "base/real.h"

typedef struct vec3 {
    real x, y, z;
} vec3;

static inline vec3 vec3_make(real x, real y, real z)
{
    return (vec3){x, y, z};
}

/* Reads a vector from three consecutive numbers, such as a pixel's. */
static inline vec3 vec3_of(const real *p)
{
    return (vec3){p[0], p[1], p[2]};
}

/* Writes a vector to three consecutive numbers. */
static inline void vec3_put(vec3 v, real *p)
{
    p[0] = v.x;
    p[1] = v.y;
    p[2] = v.z;
}

static inline vec3 vec3_add(vec3 a, vec3 b)
{
    return (vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline vec3 vec3_sub(vec3 a, vec3 b)
{
    return (vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline vec3 vec3_mul(vec3 a, vec3 b)
{
    return (vec3){a.x * b.x, a.y * b.y, a.z * b.z};
}

static inline vec3 vec3_scale(vec3 a, real s)
{
    return (vec3){a.x * s, a.y * s, a.z * s};
}

/* Returns a + s b. */
static inline vec3 vec3_fma(vec3 a, real s, vec3 b)
{
    return (vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline real vec3_dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vec3 vec3_cross(vec3 a, vec3 b)
{
    return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline real vec3_length(vec3 a)
{
    return sqrt(vec3_dot(a, a));
}

/* Returns a / |a|; the zero vector stays zero. */
static inline vec3 vec3_normalize(vec3 a)
{
    real length = vec3_length(a);
    return length > 0 ? vec3_scale(a, 1 / length) : a;
}

static inline vec3 vec3_lerp(vec3 a, vec3 b, real t)
{
    return vec3_fma(vec3_scale(a, 1 - t), t, b);
}

/* Returns the angle between vectors of any lengths in degrees; 0 if one is zero. By atan2, as the arc cosine of the dot
 * product loses all precision near zero. */
static inline double vec3_angle(vec3 a, vec3 b)
{
    return atan2((double)vec3_length(vec3_cross(a, b)), (double)vec3_dot(a, b)) * (180 / 3.14159265358979323846);
}

#endif
