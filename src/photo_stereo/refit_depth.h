/* SPDX-License-Identifier: MIT */
/* Depth that agrees with normals that photometric stereo has found: a network's depth has the shape of its own.
 *
 *     status s = refit_depth(&maps);
 */
#ifndef MERLIN_PHOTO_STEREO_REFIT_DEPTH_H
#define MERLIN_PHOTO_STEREO_REFIT_DEPTH_H

#include "estimate/surface/surface.h"
#include "merlin/maps.h"

/* Number of pixels up to which normals are integrated as they are. More are integrated by blocks of 2 × 2, 3 × 3 and so
 * on, which takes a fraction of the memory: what is finer comes from the normals when both are fused. */
enum { REFIT_INTEGRATED = 8000000 };

/* Replaces the maps' depth by the integral of their normals, at the mean distance of the present one, fused with them
 * (fuse_depth), which knows the true lines of sight. MERLIN_NO_MEMORY. */
status refit_depth(merlin_maps *maps);

/* Does the same with a surface of which only normal, depth, mask and lens are there; the mask becomes 0 or 1. most:
 * REFIT_INTEGRATED. */
status refit_surface_depth(surface *part, size_t most);

#endif
