/* SPDX-License-Identifier: MIT */
/* Figures about a surface for reports.
 *
 *     merlin_statistics residual;
 *     status s = surface_statistics(&surface, &surface.residual, &residual);
 */
#ifndef MERLIN_STEREO_INTEGRATE_SURFACE_STATISTICS_H
#define MERLIN_STEREO_INTEGRATE_SURFACE_STATISTICS_H

#include "stereo/capture/capture.h"

/* Summarizes a map of a surface, such as its residual, over the mask; zeros without one. MERLIN_NO_MEMORY. */
status surface_statistics(const merlin_surface *s, const img *map, merlin_statistics *out);
/* Summarizes the angles, in degrees, between the normals and the capture's true ones where both are known; zeros for a
 * capture without. MERLIN_NO_MEMORY. */
status surface_normal_error(const merlin_surface *s, const merlin_capture *c, merlin_statistics *out);

#endif
