/* SPDX-License-Identifier: MIT */
/* Finds the object of a photograph that has no mask: the part that its colours, its place and the photograph's edges
 * separate from the background at the border.
 *
 * Flash photographs in the dark have a dark background, product photographs a uniform one; a few colours describe both.
 * They do not describe a cluttered room, which then results in a low confidence. */
#ifndef MERLIN_ESTIMATE_OBJECT_FIND_OBJECT_H
#define MERLIN_ESTIMATE_OBJECT_FIND_OBJECT_H

#include "image/image.h"
#include "merlin/merlin.h"

/* Finds the mask (1 channel of the photograph's size in [0, 1], with edges that follow the photograph): the connected
 * region with the largest weight, and others with at least a tenth of it, or those that contain the hint's points.
 * hint: sound, or NULL. confidence: in [0, 1], the probability that mask and object have 0.97 of their union in common.
 * MERLIN_BAD_INPUT if nothing differs from the background. */
status find_object(const img *photo, const merlin_hint *hint, img *mask, float *confidence);

/* Finds it again in the next frame: before is its mask there, at the place where it is expected now. *overlap: the
 * intersection over union of both, at the size of the search. Fails only without memory. */
status find_object_again(const img *photo, const img *before, img *mask, float *overlap);

#endif
