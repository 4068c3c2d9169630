/* SPDX-License-Identifier: MIT */
/* The light of near lights at a point.
 *
 *     pst_near_lights lights;
 *     pst_near_lights_at(problem, point, &lights);
 *     pst_near_lights_divide(&lights, padded, value, usable);     as if all were distant and of one power
 */
#ifndef MERLIN_STEREO_FIT_NEAR_LIGHTS_H
#define MERLIN_STEREO_FIT_NEAR_LIGHTS_H

#include "stereo/fit/pixel_fit.h"
#include "stereo/fit/problem.h"

/* Unit directions and arriving power; pst_padded(lights), the padding 0. */
typedef struct pst_near_lights {
    float x[PST_MAX_LIGHTS], y[PST_MAX_LIGHTS], z[PST_MAX_LIGHTS], power[PST_MAX_LIGHTS];
} pst_near_lights;

/* Computes directions and power. A point source falls off with the squared distance; an LED also with a power of the
 * cosine to its axis. */
void pst_near_lights_at(const pst_problem *p, vec3 at, pst_near_lights *out);

/* Divides values by the arriving power; where it is very small, values become unusable. */
void pst_near_lights_divide(const pst_near_lights *l, int padded, float *value, float *usable);

#endif
