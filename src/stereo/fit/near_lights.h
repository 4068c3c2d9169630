/* SPDX-License-Identifier: MIT */
/* What near lights send to a point.
 *
 *     pst_near_lights lights;
 *     pst_near_lights_at(problem, point, &lights);
 *     pst_near_lights_divide(&lights, padded, value, usable);     as if all were distant and alike */
#ifndef MERLIN_STEREO_FIT_NEAR_LIGHTS_H
#define MERLIN_STEREO_FIT_NEAR_LIGHTS_H

#include "stereo/fit/pixel_fit.h"
#include "stereo/fit/problem.h"

/* Unit directions and what arrives; pst_padded(lights), the padding 0. */
typedef struct pst_near_lights {
    float x[PST_MAX_LIGHTS], y[PST_MAX_LIGHTS], z[PST_MAX_LIGHTS], power[PST_MAX_LIGHTS];
} pst_near_lights;

/* A point source falls off with the squared distance, an LED also with the lobe's power of the cosine to its axis. */
void pst_near_lights_at(const pst_problem *p, vec3 at, pst_near_lights *out);

/* Values by what arrives; where hardly anything does, nothing is usable. */
void pst_near_lights_divide(const pst_near_lights *l, int padded, float *value, float *usable);

#endif
