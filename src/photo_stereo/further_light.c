/* SPDX-License-Identifier: MIT */
#include "photo_stereo/further_light.h"

#include <math.h>

#include "stereo/algebra/matrix3.h"

/* Number of directions that are tried; cosine of the largest angle to +z: from further aside little of an object is
 * lit. */
enum { TRIED = 256 };
static const float least_cosine = 0.5f;
/* Added to the sum as so much light from everywhere, so that a direction far from few lights has a finite value. */
static const float ground = 0.05f;

/* Returns direction number i of a spiral over the cap, from its middle to its edge. */
static vec3 direction(int i)
{
    const float z = 1 - (1 - least_cosine) * ((float)i + 0.5f) / TRIED, across = sqrtf(1 - z * z);
    const float turn = 2.3999632f * (float)i;
    return vec3_make(across * cosf(turn), across * sinf(turn), z);
}

vec3 further_light(const vec3 *light, int count)
{
    float m[6] = {ground, 0, 0, ground, 0, ground}, most = 0;
    vec3 best = vec3_make(0, 0, 1);
    for (int k = 0; k < count; k++)
        pst_add_outer3(m, light[k], light[k]);
    for (int i = 0; i < TRIED; i++) {
        const vec3 l = direction(i);
        const float told = vec3_dot(l, pst_solve3(m, l));
        if (told <= most) continue;
        most = told;
        best = l;
    }
    return best;
}
