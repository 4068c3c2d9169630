/* SPDX-License-Identifier: MIT */
/* What tests of environments share: a map of what a function says of each direction. */
#ifndef MERLIN_TESTS_ESTIMATE_SURROUNDINGS_H
#define MERLIN_TESTS_ESTIMATE_SURROUNDINGS_H

#include "estimate/light/env_map.h"
#include "optics/latlong.h"

/* Radiance is taken in the middle of every texel of width × width / 2. Free it with env_map_free. */
static inline status surroundings(vec3 (*radiance)(vec3), int width, env_map *out)
{
    int height = width / 2;
    img latlong;
    status s = img_new(&latlong, width, height, 3);
    if (s != OK) return s;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            vec3 c = radiance(latlong_direction(((float)x + 0.5f) / (float)width, ((float)y + 0.5f) / (float)height));
            float *p = img_at(&latlong, x, y);
            p[0] = c.x;
            p[1] = c.y;
            p[2] = c.z;
        }
    s = env_map_new(&latlong, out);
    img_free(&latlong);
    return s;
}

#endif
