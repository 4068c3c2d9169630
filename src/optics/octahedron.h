/* SPDX-License-Identifier: MIT */
/* An equal-area map from the sphere of directions to a square: an octahedron with curved faces, unfolded (P. Clarberg,
 * Fast equal-area mapping of the (hemi)sphere using SIMD, JGT 13(3), 2008).
 *
 *     octahedron_place(d, &x, &y);              the point of a unit direction in the unit square
 *     vec3 d = octahedron_direction(x, y);      the inverse
 *
 * +z is the square's middle, -z its four corners. */
#ifndef MERLIN_OPTICS_OCTAHEDRON_H
#define MERLIN_OPTICS_OCTAHEDRON_H

#include "base/vec.h"

static inline void octahedron_place(vec3 d, real *x, real *y)
{
    real r = sqrt(fmax((real)0, 1 - fabs(d.z)));
    real v = r * atan2(fabs(d.y), fabs(d.x)) * (2 / PI), u = r - v;
    if (d.z < 0) {
        real t = u;
        u = 1 - v;
        v = 1 - t;
    }
    *x = (real)0.5 + (real)0.5 * copysign(u, d.x);
    *y = (real)0.5 + (real)0.5 * copysign(v, d.y);
}

static inline vec3 octahedron_direction(real x, real y)
{
    real u = fabs(2 * x - 1), v = fabs(2 * y - 1), height = 1 - (u + v), r = 1 - fabs(height);
    real around = r > 0 ? (PI / 4) * ((v - u) / r + 1) : 0, across = r * sqrt(2 - r * r);
    return vec3_make(copysign(across * cos(around), x - (real)0.5), copysign(across * sin(around), y - (real)0.5),
                     copysign(1 - r * r, height));
}

#endif
