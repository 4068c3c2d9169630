/* SPDX-License-Identifier: MIT */
/* How unlike a picture's border its pixels are: how far colours must change on the way there.
 *
 *     img away;                                  colours and ring of one size
 *     status s = border_distance(&color, ring, &away);
 *
 * The least difference between highest and lowest value of any path to the background's part of the border, in each
 * channel (minimum barrier distance, Strand et al. 2013): shading that ends where it began costs nothing, an outline
 * costs its whole step however it is reached. */
#ifndef MERLIN_ESTIMATE_OBJECT_BORDER_DISTANCE_H
#define MERLIN_ESTIMATE_OBJECT_BORDER_DISTANCE_H

#include <stdint.h>

#include "image/image.h"

/* color: 3 channels in [0, 1]. ring: 1 for pixels of the border, else 0; there must be some. out, made here: 1 channel
 * in [0, 3], the channels' sum. Border pixels are background if their colour is there on another side, too: an object
 * that the picture cuts off at one side is none. */
status border_distance(const img *color, const uint8_t *ring, img *out);

/* The same from pixels that are 1 in seed, whatever their colours. */
status barrier_distance(const img *color, const uint8_t *seed, img *out);

#endif
