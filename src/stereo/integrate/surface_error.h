/* SPDX-License-Identifier: MIT */
/* A surface by photometric stereo held against the truth that its capture has.
 *
 *     size_t pixels;
 *     double degrees = normal_mean_angle(&surface.normal, &capture, &pixels);
 *     double share = depth_mean_error(&surface.depth, &capture); */
#ifndef MERLIN_STEREO_INTEGRATE_SURFACE_ERROR_H
#define MERLIN_STEREO_INTEGRATE_SURFACE_ERROR_H

#include "stereo/capture/capture.h"

/* Between unit vectors, in degrees. */
double normal_angle(vec3 a, vec3 b);

/* The mean angle in degrees to c->normal_true over the mask, where the truth is known; *pixels (may be NULL) gets how
 * many those are. 0 if there are none. */
double normal_mean_angle(const img *normal, const merlin_capture *c, size_t *pixels);

/* The mean share of c->depth_true by which the depth is off over the mask, once its scale is aligned. */
double depth_mean_error(const img *depth, const merlin_capture *c);

#endif
