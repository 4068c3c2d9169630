/* SPDX-License-Identifier: MIT */
/* The reflection of an environment at one point of a surface: the specular lobe over an environment map.
 *
 *     lobe_sampler l;
 *     lobe_over(&env, NULL, &l);
 *     vec3 radiance = lobe_reflection(&l, &(lobe_point){normal, view, 0.3f, x, y});
 *
 * The half vectors are importance-sampled at the same 64 places of the lobe for every point; each sample is looked up
 * as a mean over the solid angle that it stands for (Křivánek & Colbert 2008). There is no noise; a lamp's highlight
 * has an error of up to a tenth of its peak. */
#ifndef MERLIN_ESTIMATE_LIGHT_LOBE_SAMPLER_H
#define MERLIN_ESTIMATE_LIGHT_LOBE_SAMPLER_H

#include "estimate/light/env_map.h"
#include "estimate/light/horizon.h"

enum { LOBE_SAMPLES = 64 };

/* Place of a sample on the disc; its radius depends on the roughness. */
typedef struct lobe_place {
    float u, cosine, sine;
} lobe_place;

typedef struct lobe_sampler {
    const env_map *env;
    const horizon *hidden;
    lobe_place places[LOBE_SAMPLES];
} lobe_sampler;

typedef struct lobe_point {
    vec3 normal, view; /* unit vectors */
    float roughness;
    float x, y; /* place of the horizon lookup, in shares of the frame */
} lobe_point;

/* Sets up the sampler. hidden: the part of env that the surface hides, or NULL. Both are borrowed. */
void lobe_over(const env_map *env, const horizon *hidden, lobe_sampler *out);

/* Returns the radiance toward the viewer. */
vec3 lobe_reflection(const lobe_sampler *l, const lobe_point *p);

#endif
