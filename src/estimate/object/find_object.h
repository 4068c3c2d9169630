/* SPDX-License-Identifier: MIT */
/* Finds the object of a photograph that has no mask: what its colours, its place and the photograph's edges set apart
 * from the border's background.
 *
 * Photographs by flash in the dark have a dark background, product photographs an even one; both are what a few colours
 * describe. A cluttered room is not, and the confidence says so. */
#ifndef MERLIN_ESTIMATE_OBJECT_FIND_OBJECT_H
#define MERLIN_ESTIMATE_OBJECT_FIND_OBJECT_H

#include "image/image.h"
#include "merlin/merlin.h"

/* hint: sound, or NULL. mask: 1 channel of the photograph's size in [0, 1], edges following the photograph: the
 * heaviest connected region, and others that weigh at least a tenth of it, or those that hold the hint's points.
 * confidence in [0, 1]: how likely mask and object have 0.97 of their union in common. MERLIN_BAD_INPUT if nothing
 * stands out at all. */
status find_object(const img *photo, const merlin_hint *hint, img *mask, float *confidence);

#endif
