/* SPDX-License-Identifier: MIT */
/* Makes depth agree with normals.
 *
 *     status s = fuse_depth(&normal, &mask, 60, &depth);
 *
 * merlin estimate writes depth like this, and shadows use it. A network's depth is right at coarse scales, its normals
 * at fine ones: the depth alone is bumpy where the normals are smooth. Nehab et al. 2005 combine the two; here in log
 * depth, where a plane's normal gives the step from a pixel to its neighbour exactly: ln(z_j / z_i) = ln((n·r_i) /
 * (n·r_j)), with r the pixels' rays. The minimum is that of
 *
 *     Σ (u - ln z)² / ℓ²  +  Σ w (u_j - u_i - step)²,   w = 1 / (1 + (e/σ)⁴),  e = ln(z_j / z_i) - step
 *
 * over pixels and pairs of neighbours. Depth determines structures wider than ℓ pixels, normals finer ones; w removes
 * the pairs where depth is discontinuous. */
#ifndef MERLIN_ESTIMATE_SURFACE_FUSE_H
#define MERLIN_ESTIMATE_SURFACE_FUSE_H

#include "image/image.h"
#include "optics/camera.h"

/* Replaces depth (positive inside the mask) by the solution. normal: 3 channels, unit. mask: pixels from 0.5 on belong
 * to the surface. */
status fuse_depth(const img *normal, const img *mask, camera_lens lens, img *depth);

#endif
