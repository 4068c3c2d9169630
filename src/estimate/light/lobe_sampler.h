/* SPDX-License-Identifier: MIT */
/* What one point of a surface mirrors of its surroundings: the specular lobe over an environment map.
 *
 *     lobe_sampler l;
 *     lobe_over(&env, NULL, &l);
 *     vec3 radiance = lobe_reflection(&l, &(lobe_point){normal, view, 0.3f, x, y});
 *
 * By importance sampling of the half vectors, the same 64 places on the lobe for every point, each looked up as a mean
 * over the solid angle that it stands for (Křivánek & Colbert 2008). There is no noise; a lamp's highlight is off by up
 * to a tenth of its peak. */
#ifndef MERLIN_ESTIMATE_LIGHT_LOBE_SAMPLER_H
#define MERLIN_ESTIMATE_LIGHT_LOBE_SAMPLER_H

#include "estimate/light/env_map.h"
#include "estimate/light/horizon.h"

enum { LOBE_SAMPLES = 64 };

/* Where a sample lies on the disc: its radius is a matter of the roughness. */
typedef struct lobe_place {
    float u, cosine, sine;
} lobe_place;

typedef struct lobe_sampler {
    const env_map *env;
    const horizon *hidden;
    lobe_place places[LOBE_SAMPLES];
} lobe_sampler;

typedef struct lobe_point {
    vec3 normal, view; /* unit */
    float roughness;
    float x, y; /* where the horizon is looked up: shares of the frame */
} lobe_point;

/* hidden: what the surface hides of env; or NULL. Both are borrowed. */
void lobe_over(const env_map *env, const horizon *hidden, lobe_sampler *out);

/* Radiance toward the viewer. */
vec3 lobe_reflection(const lobe_sampler *l, const lobe_point *p);

#endif
