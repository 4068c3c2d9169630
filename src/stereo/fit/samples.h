/* SPDX-License-Identifier: MIT */
/* A sample of pixels under all lights as one matrix, factored into lights times surface, for solvers that do not know
 * all about the light.
 *
 *     pst_samples m;
 *     status s = pst_samples_new(p, 1000, &m);
 *     s = pst_samples_basis(&m, basis);          the best rank three, count × 3
 *     pst_samples_fit(&m, x, y, z);              b and weight of every pixel under the lights x, y, z (padded)
 *     pst_samples_free(&m);
 */
#ifndef MERLIN_STEREO_FIT_SAMPLES_H
#define MERLIN_STEREO_FIT_SAMPLES_H

#include "stereo/fit/problem.h"

typedef struct pst_samples {
    int lights;
    size_t padded, count; /* floats per pixel; number of pixels */
    float *value, *usable, *weight;
    vec3 *b;
    uint32_t *pixel;
} pst_samples;

status pst_samples_new(const pst_problem *p, size_t count, pst_samples *out);
void pst_samples_free(pst_samples *m);

/* Computes the left singular vectors of the three largest singular values, multiplied by these, lights × 3, over the
 * pixels that no light leaves dark or saturated (over all, if these are few). *lit gets their number. */
status pst_samples_basis(const pst_samples *m, double *basis, size_t *lit);

/* Finds out whether the pictures differ in more than brightness and noise. */
status pst_samples_differ(const pst_samples *m, bool *differ);

void pst_samples_fit(pst_samples *m, const float *x, const float *y, const float *z);

#endif
