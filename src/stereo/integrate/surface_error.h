/* SPDX-License-Identifier: MIT */
/* Errors of a surface found by photometric stereo, compared with its capture's ground truth.
 *
 *     size_t pixels;
 *     double degrees = normal_mean_angle(&surface.normal, &capture, &pixels);
 *     double share = depth_mean_error(&surface.depth, &capture);
 */
#ifndef MERLIN_STEREO_INTEGRATE_SURFACE_ERROR_H
#define MERLIN_STEREO_INTEGRATE_SURFACE_ERROR_H

#include "stereo/capture/capture.h"

/* Returns the mean angle in degrees to c->normal_true over the mask where the truth is known; 0 if it is not known
 * anywhere. *pixels (may be NULL) gets the number of pixels. */
double normal_mean_angle(const img *normal, const merlin_capture *c, size_t *pixels);

/* Returns the mean error of depth over the mask as a share of c->depth_true, after aligning its scale. */
double depth_mean_error(const img *depth, const merlin_capture *c);

#endif
