/* SPDX-License-Identifier: MIT */
/* The priors of bundle.h, as parts of a step's equations. */
#ifndef MERLIN_STEREO_UNCALIBRATED_BUNDLE_PRIORS_H
#define MERLIN_STEREO_UNCALIBRATED_BUNDLE_PRIORS_H

#include "stereo/uncalibrated/bundle.h"

/* Equations of a step: unknowns are the corners, then bundle_light_unknowns per light: two rotations about the centre
 * (radians), the logarithm of its distance and, if it is free, that of its strength. */
typedef struct bundle_equations {
    int size;
    size_t corners;
    double *matrix; /* lower triangle, row-major */
    double *right, *coupling;
    double *damped, *step;
    vec3 *turn; /* lights × 3: derivatives of a light's position by its unknowns */
    float *old_depth, *old_albedo;
    vec3 *old_position;
    float *old_strength;
} bundle_equations;

/* Returns the number of a light's unknowns: 3 of its position, and its strength if it is free. */
static inline int bundle_light_unknowns(const bundle *b)
{
    return b->kind == BUNDLE_NEAR_FREE ? 4 : 3;
}

/* Returns the index of a light's first unknown. */
static inline size_t bundle_light_row(const bundle *b, int light)
{
    return (size_t)b->corners + (size_t)bundle_light_unknowns(b) * (size_t)light;
}

/* Adds the priors, and returns their cost; y NULL: only that. matrix is half the second derivative. */
double bundle_add_priors(const bundle *b, bundle_equations *y);

#endif
