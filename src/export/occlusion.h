/* SPDX-License-Identifier: MIT */
/* Ambient occlusion of a visible surface by itself. */
#ifndef MERLIN_EXPORT_OCCLUSION_H
#define MERLIN_EXPORT_OCCLUSION_H

#include "estimate/surface/surface.h"

/* Computes for every pixel of `fine` the cosine-weighted share of directions around its normal that `coarse`, the same
 * surface of any size, leaves open: 1 channel in [0, 1] of fine's size, 1 outside the object. */
status occlusion_of(const surface *coarse, const surface *fine, img *out);

#endif
