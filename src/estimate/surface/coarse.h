/* SPDX-License-Identifier: MIT */
/* Joins two estimates of one surface: the coarse part of one that knows more, and the detail of a larger one.
 *
 *     surface fine, coarse;       256 and 96 pixels wide, say
 *     status s = surface_take_coarse(&coarse, (coarse_share){0.5f, 0.5f, 1, 0.5f}, &fine);
 */
#ifndef MERLIN_ESTIMATE_SURFACE_COARSE_H
#define MERLIN_ESTIMATE_SURFACE_COARSE_H

#include "estimate/surface/surface.h"

/* Shares of the coarse estimate in the mean of both, in [0, 1]. */
typedef struct coarse_share {
    float albedo, normal, roughness, depth;
} coarse_share;

/* Changes a surface by a share of what it differs, at the size of the coarse one, from that: normals, roughness and
 * depth by differences, albedo by ratios, at most 4. Both have the same frame. MERLIN_NO_MEMORY. */
status surface_take_coarse(const surface *coarse, coarse_share share, surface *fine);

#endif
