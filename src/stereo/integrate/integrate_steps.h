/* SPDX-License-Identifier: MIT */
/* Neighbours and steps between them, shared by both methods of integration. Internal.
 *
 * The unknown x is depth in pixels (orthographic) or the logarithm of depth (perspective; Quéau, Durou & Aujol 2018,
 * "Normal integration: a survey"). A surface point is d r with the pixel's ray r = ((u − cx)/f, −(v − cy)/f, −1). The
 * chord to the neighbour's point d' r' is perpendicular to some m:  d'/d = (m·r)/(m·r'). */
#ifndef MERLIN_STEREO_INTEGRATE_INTEGRATE_STEPS_H
#define MERLIN_STEREO_INTEGRATE_INTEGRATE_STEPS_H

#include "stereo/capture/capture.h"
#include "stereo/integrate/poisson.h"

typedef struct integration_steps {
    const img *normal;
    pinhole camera;
    poisson_grid grid;
    const watch *watch;
} integration_steps;

/* Integrates by bilaterally weighted least squares (Cao et al., ECCV 2022, "Bilateral normal integration"), starting
 * from x: repeated solutions in which each side of a pixel is weighted by the fit of the other. stepped: x already has
 * its jumps. */
status integrate_edges(integration_steps *s, poisson_solver *solver, bool stepped, double *x);

#endif
