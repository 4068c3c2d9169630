/* SPDX-License-Identifier: MIT */
/* The priors of bundle.h, as parts of a step's equations. */
#ifndef MERLIN_STEREO_UNCALIBRATED_BUNDLE_PRIORS_H
#define MERLIN_STEREO_UNCALIBRATED_BUNDLE_PRIORS_H

#include "stereo/uncalibrated/bundle.h"

/* Equations of a step: unknowns are the corners, then three per light: two rotations about the centre (radians), and
 * the logarithm of its distance. */
typedef struct bundle_equations {
    int size;
    size_t corners;
    double *matrix; /* lower triangle, row-major */
    double *right, *coupling;
    double *damped, *step;
    vec3 *turn; /* lights × 3: derivatives of a light's position by its unknowns */
    float *old_depth, *old_albedo;
    vec3 *old_position;
} bundle_equations;

/* Adds the priors, and returns their cost; y NULL: only that. matrix is half the second derivative. */
double bundle_add_priors(const bundle *b, bundle_equations *y);

#endif
