/* SPDX-License-Identifier: MIT */
/* The network's input, made from a photograph.
 *
 *     img picture, seen;
 *     status s = input_make(&crop_photo, &crop_mask, NETWORK_SIZE, &picture, &seen);
 *     if (s == OK) input_expose(&picture, gain);
 */
#ifndef MERLIN_ESTIMATE_PHOTO_INPUT_H
#define MERLIN_ESTIMATE_PHOTO_INPUT_H

#include "image/image.h"

/* Makes a picture like a rendered sample: the photograph multiplied by coverage and area-averaged to size × size, and a
 * mask of 0 or 1. */
status input_make(const img *photo, const img *mask, int size, img *picture, img *seen);

/* Converts values to radiance by a photograph's gain (exposure.h). */
void input_expose(img *picture, float gain);

#endif
