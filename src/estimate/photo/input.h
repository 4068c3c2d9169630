/* SPDX-License-Identifier: MIT */
/* The picture that the network sees of a photograph.
 *
 *     img picture, seen;
 *     status s = input_make(&crop_photo, &crop_mask, NETWORK_SIZE, &picture, &seen);
 *     if (s == OK) input_expose(&picture, gain); */
#ifndef MERLIN_ESTIMATE_PHOTO_INPUT_H
#define MERLIN_ESTIMATE_PHOTO_INPUT_H

#include "image/image.h"

/* Like a rendered sample: the photograph multiplied by coverage and area-averaged to size × size, the mask 0 or 1. */
status input_make(const img *photo, const img *mask, int size, img *picture, img *seen);

/* Radiance, by a photograph's gain (exposure.h). */
void input_expose(img *picture, float gain);

#endif
