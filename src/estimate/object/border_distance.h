/* SPDX-License-Identifier: MIT */
/* Difference of pixels from a picture's border: how much colours must change on the way there.
 *
 *     img away;                                  same size as the colours and the ring
 *     status s = border_distance(&color, ring, &away);
 *
 * It is the least difference between the highest and lowest value along any path to the background's part of the
 * border, in each channel (minimum barrier distance, Strand et al. 2013): shading that returns to its first value costs
 * nothing, an outline costs its full contrast however it is reached. */
#ifndef MERLIN_ESTIMATE_OBJECT_BORDER_DISTANCE_H
#define MERLIN_ESTIMATE_OBJECT_BORDER_DISTANCE_H

#include <stdint.h>

#include "image/image.h"

/* Computes the distance. color: 3 channels in [0, 1]. ring: 1 for pixels of the border, else 0; there must be some.
 * out, made here: 1 channel in [0, 3], the sum over the channels. A border pixel is background only if its colour also
 * occurs on another side of the border, so that an object which one side of the picture cuts off is not. */
status border_distance(const img *color, const uint8_t *ring, img *out);

/* Computes the distance from all pixels that are 1 in seed, whatever their colours. */
status barrier_distance(const img *color, const uint8_t *seed, img *out);

#endif
