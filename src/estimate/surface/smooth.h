/* SPDX-License-Identifier: MIT */
/* Removes a pattern that the network's last layer leaves.
 *
 * The layer makes four pixels from one, each by its own weights, so that its output has a faint pattern with a period
 * of two pixels. The binomial filter (1 2 1)/4 is zero exactly at that frequency, and hardly changes anything coarser.
 */
#ifndef MERLIN_ESTIMATE_SURFACE_SMOOTH_H
#define MERLIN_ESTIMATE_SURFACE_SMOOTH_H

#include "estimate/surface/surface.h"

/* Filters an image in both directions; values where mask < 0.5 have no effect. */
status smooth_inside(img *image, const img *mask);

/* Filters normals, roughness and depth of an estimate inside its mask. Albedo has edges of one pixel, which the
 * photograph restores (surface_refine); shape has no such edges. */
status smooth_estimate(surface *s);

#endif
