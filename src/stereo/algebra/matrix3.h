/* SPDX-License-Identifier: MIT */
/* Systems of three equations, for a pixel's normal from its values. */
#ifndef MERLIN_STEREO_ALGEBRA_MATRIX3_H
#define MERLIN_STEREO_ALGEBRA_MATRIX3_H

#include "base/vec.h"

/* Factors L D Lᵀ of a symmetric 3×3 matrix (xx, xy, xz, yy, yz, zz), slightly damped so that a singular one gives the
 * shortest solution instead of infinity. Each pivot is at least the damping; a determinant would be lost in rounding
 * errors for a matrix from a single light. */
typedef struct pst_factors {
    float yx, zx, zy; /* entries of L below its diagonal of 1 */
    float x, y, z;    /* reciprocals of D */
} pst_factors;

static inline pst_factors pst_factor3(float xx, float xy, float xz, float yy, float yz, float zz)
{
    float damping = 1e-6f * (xx + yy + zz) + 1e-30f;
    pst_factors f = {.x = 1 / (xx + damping)};
    f.yx = xy * f.x;
    f.zx = xz * f.x;
    float rest = yz - f.zx * xy, second = yy - f.yx * xy;
    f.y = 1 / ((second > 0 ? second : 0) + damping);
    f.zy = rest * f.y;
    float third = zz - f.zx * xz - f.zy * rest;
    f.z = 1 / ((third > 0 ? third : 0) + damping);
    return f;
}

/* Returns x of L D Lᵀ x = b. */
static inline vec3 pst_solve_factored(pst_factors f, vec3 b)
{
    float y = b.y - f.yx * b.x, z = (b.z - f.zx * b.x - f.zy * y) * f.z;
    y = y * f.y - f.zy * z;
    return (vec3){b.x * f.x - f.yx * y - f.zx * z, y, z};
}

static inline vec3 pst_solve3(const float m[6], vec3 b)
{
    return pst_solve_factored(pst_factor3(m[0], m[1], m[2], m[3], m[4], m[5]), b);
}

/* Adds a vᵀ, where a is a multiple of v, to a symmetric matrix in that order. */
static inline void pst_add_outer3(float m[6], vec3 a, vec3 v)
{
    m[0] += a.x * v.x;
    m[1] += a.x * v.y;
    m[2] += a.x * v.z;
    m[3] += a.y * v.y;
    m[4] += a.y * v.z;
    m[5] += a.z * v.z;
}

/* Returns n as a unit vector that faces the camera; (0, 0, 1) if it is zero. */
static inline vec3 pst_facing(vec3 n)
{
    float length = vec3_length(n);
    if (!(length > 1e-20f) || !(length < 1e20f)) return vec3_make(0, 0, 1);
    n = vec3_scale(n, 1 / length);
    if (n.z < 1e-3f) n = vec3_normalize(vec3_make(n.x, n.y, 1e-3f));
    return n;
}

#endif
