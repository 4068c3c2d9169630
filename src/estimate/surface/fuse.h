/* SPDX-License-Identifier: MIT */
/* Depth made to agree with normals.
 *
 *     status s = fuse_depth(&normal, &mask, 60, &depth);
 *
 * So it is written by merlin estimate, and followed by shadows. A network's depth knows where things are, its normals
 * how the surface runs; taken by itself, the depth is bumpy where the normals are smooth. Nehab et al. 2005 join the
 * two. Here in log depth, in which a plane's normal gives the step from a pixel to its neighbour exactly: ln(z_j / z_i)
 * = ln((n·r_i) / (n·r_j)), r being the pixels' rays. Minimized:
 *
 *     Σ (u - ln z)² / ℓ²  +  Σ w (u_j - u_i - step)²,   w = 1 / (1 + (e/σ)⁴),  e = ln(z_j / z_i) - step
 *
 * over pixels and pairs of neighbours. Depth rules what is wider than ℓ pixels, normals what is finer; w lets go where
 * the depth jumps. */
#ifndef MERLIN_ESTIMATE_SURFACE_FUSE_H
#define MERLIN_ESTIMATE_SURFACE_FUSE_H

#include "image/image.h"
#include "optics/camera.h"

/* normal: 3 channels, unit. mask: pixels from 0.5 on belong to the surface. depth: positive inside, changed there.
 */
status fuse_depth(const img *normal, const img *mask, camera_lens lens, img *depth);

#endif
