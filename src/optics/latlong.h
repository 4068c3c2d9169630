/* SPDX-License-Identifier: MIT */
/* Latitude-longitude maps: the top row is up (+y), columns run around the y axis, the middle one is straight ahead of
 * the camera (-z) and columns right of it lie to the camera's right.
 *
 *     vec3 d = latlong_direction(u, v);     the unit direction at a point of the map, u and v from 0 to 1
 *     latlong_place(d, &u, &v);             the inverse
 *     float angle = latlong_solid_angle(row, width, height);     of one texel
 */
#ifndef MERLIN_OPTICS_LATLONG_H
#define MERLIN_OPTICS_LATLONG_H

#include "base/vec.h"

static inline vec3 latlong_direction(real u, real v)
{
    real around = (u - (real)0.5) * 2 * PI, down = v * PI, s = sin(down);
    return vec3_make(s * sin(around), cos(down), -s * cos(around));
}

static inline void latlong_place(vec3 d, real *u, real *v)
{
    real y = d.y < -1 ? (real)-1 : d.y > 1 ? (real)1 : d.y;
    *u = atan2(d.x, -d.z) / (2 * PI) + (real)0.5;
    *v = acos(y) / PI;
}

/* Returns the solid angle of a texel in this row, steradians. */
static inline real latlong_solid_angle(int row, int width, int height)
{
    real top = cos(PI * (real)row / (real)height), bottom = cos(PI * (real)(row + 1) / (real)height);
    return (top - bottom) * 2 * PI / (real)width;
}

#endif
