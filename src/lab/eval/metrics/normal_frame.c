/* SPDX-License-Identifier: MIT */
#include "lab/eval/metrics/normal_frame.h"

#include "stereo/fit/field_fit.h"

static vec3 sight(const pinhole *camera, int x, int y)
{
    return pinhole_is_near(camera) ? vec3_normalize(pst_ray(camera, x, y)) : vec3_make(0, 0, -1);
}

/* v turned by the least rotation that takes unit a to unit b (Rodrigues' formula; a and b are not opposite). */
static vec3 turn(vec3 v, vec3 a, vec3 b)
{
    vec3 axis = vec3_cross(a, b), once = vec3_cross(axis, v);
    return vec3_fma(vec3_add(v, once), 1 / (1 + vec3_dot(a, b)), vec3_cross(axis, once));
}

void normal_frame_change(img *normal, const pinhole *from, const pinhole *to)
{
    for (int y = 0; y < normal->height; y++)
        for (int x = 0; x < normal->width; x++) {
            float *n = img_at(normal, x, y);
            vec3 turned = turn(vec3_of(n), sight(from, x, y), sight(to, x, y));
            vec3_put(turned, n);
        }
}
