/* SPDX-License-Identifier: MIT */
/* A sample of pixels under all lights as one matrix, factored into lights times surface: what the solvers that do not
 * know all of the light work on.
 *
 *     pst_samples m;
 *     status s = pst_samples_new(p, 1000, &m);
 *     s = pst_samples_basis(&m, basis);          the best rank three, count × 3
 *     pst_samples_fit(&m, x, y, z);              b and weight of every pixel under the lights x, y, z (padded)
 *     pst_samples_free(&m); */
#ifndef MERLIN_STEREO_FIT_SAMPLES_H
#define MERLIN_STEREO_FIT_SAMPLES_H

#include "stereo/fit/problem.h"

typedef struct pst_samples {
    int lights;
    size_t padded, count; /* floats a pixel; pixels */
    float *value, *usable, *weight;
    vec3 *b;
    uint32_t *pixel;
} pst_samples;

status pst_samples_new(const pst_problem *p, size_t count, pst_samples *out);
void pst_samples_free(pst_samples *m);

/* The three left singular vectors of the largest singular values, times these, lights × 3, of the pixels that no light
 * leaves dark or saturated (of all, if hardly any is). *lit gets how many those are. */
status pst_samples_basis(const pst_samples *m, double *basis, size_t *lit);

/* Whether the pictures differ in more than brightness and noise. */
status pst_samples_differ(const pst_samples *m, bool *differ);

void pst_samples_fit(pst_samples *m, const float *x, const float *y, const float *z);

#endif
