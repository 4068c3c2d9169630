/* SPDX-License-Identifier: MIT */
#include "stereo/fit/normal_spread.h"

#include <math.h>

#include "stereo/algebra/matrix3.h"

/* Leverage from which on an observation alone determines a direction of the normal. */
static const float decisive = 0.999f;

static vec3 direction(const pst_observations *o, int k)
{
    return vec3_make(o->x[k], o->y[k], o->z[k]);
}

static pst_factors factor(const pst_observations *o, const float *weight)
{
    float m[6] = {0};
    for (int k = 0; k < o->padded; k++)
        if (weight[k] > 0) pst_add_outer3(m, vec3_scale(direction(o, k), weight[k]), direction(o, k));
    return pst_factor3(m[0], m[1], m[2], m[3], m[4], m[5]);
}

float pst_normal_spread(const pst_observations *o, const float *weight, const float *model, vec3 n, float albedo)
{
    const pst_factors f = factor(o, weight);
    float sum = 0, count = 0;
    for (int k = 0; k < o->padded; k++) {
        if (!(weight[k] > 0)) continue;
        const vec3 l = direction(o, k), pull = pst_solve_factored(f, l);
        const float leverage = weight[k] * vec3_dot(l, pull);
        if (!(leverage < decisive)) return PST_ANY_NORMAL;
        const vec3 change = vec3_scale(pull, weight[k] * (o->value[k] - model[k]) / (1 - leverage));
        const vec3 turn = vec3_fma(change, -vec3_dot(n, change), n);
        sum += vec3_dot(turn, turn);
        count++;
    }
    if (count <= 3 || !(albedo > 0)) return PST_ANY_NORMAL;
    return atanf(sqrtf((count - 1) / count * sum) / albedo) / (float)DEGREE;
}
