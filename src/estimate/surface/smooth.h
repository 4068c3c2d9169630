/* SPDX-License-Identifier: MIT */
/* What the network's last layer leaves behind.
 *
 * It makes four pixels from one, each by weights of its own, so that a faint pattern of two pixels' period lies over
 * its answer. The binomial filter (1 2 1)/4 has its zero exactly there, and hardly touches anything coarser. */
#ifndef MERLIN_ESTIMATE_SURFACE_SMOOTH_H
#define MERLIN_ESTIMATE_SURFACE_SMOOTH_H

#include "estimate/surface/surface.h"

/* Filters an image in both directions; values where mask < 0.5 do not leak in. */
status smooth_inside(img *image, const img *mask);

/* Normals, roughness and depth of an estimate, by its own mask. Albedo has edges of one pixel, which the photograph
 * restores (surface_refine), shape has none so sharp. */
status smooth_estimate(surface *s);

#endif
