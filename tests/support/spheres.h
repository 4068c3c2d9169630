/* SPDX-License-Identifier: MIT */
/* Spheres from outside and inside as surfaces of SPHERES_SIDE pixels a side before a camera of CAMERA_FOV. */
#ifndef MERLIN_TESTS_SUPPORT_SPHERES_H
#define MERLIN_TESTS_SUPPORT_SPHERES_H

#include <math.h>
#include <stdbool.h>

#include "estimate/surface/surface.h"
#include "optics/camera.h"

enum { SPHERES_SIDE = 256, SPHERES_PIXELS = SPHERES_SIDE * SPHERES_SIDE };

/* Returns the point at depth 1 that pixel i shows. */
static inline vec3 spheres_ray(int i)
{
    const camera view = {.width = SPHERES_SIDE, .height = SPHERES_SIDE, .fov = CAMERA_FOV};
    return camera_point(&view, (float)(i % SPHERES_SIDE) + 0.5f, (float)(i / SPHERES_SIDE) + 0.5f, 1);
}

static inline void spheres_put_pixel(surface *s, int i, float depth, vec3 normal)
{
    s->depth.data[i] = depth;
    s->mask.data[i] = 1;
    s->roughness.data[i] = 0.5f;
    vec3_put(normal, s->normal.data + 3 * i);
}

/* Adds the front (nearest) or the inside (farthest) of a sphere; of the inside, what is deeper than a share of the
 * radius behind the middle. */
static inline void spheres_put(surface *s, vec3 centre, float radius, bool inside, float deeper)
{
    for (int i = 0; i < SPHERES_PIXELS; i++) {
        vec3 d = vec3_normalize(spheres_ray(i));
        float along = vec3_dot(d, centre), square = along * along - vec3_dot(centre, centre) + radius * radius;
        if (square <= 0) continue;
        vec3 p = vec3_scale(d, inside ? along + sqrtf(square) : along - sqrtf(square));
        vec3 out = vec3_scale(vec3_sub(p, centre), 1 / radius);
        if (inside && -out.z < deeper) continue;
        spheres_put_pixel(s, i, -p.z, inside ? vec3_scale(out, -1) : out);
    }
}

#endif
