/* SPDX-License-Identifier: MIT */
/* Decides which of a mask's values is the object. White on black is usual, but segmentation programs write the number
 * of a label, so that the object may be 1 or 15 of 255, nearly black: any two values make a mask. */
#ifndef MERLIN_IMAGE_READ_MASK_VALUES_H
#define MERLIN_IMAGE_READ_MASK_VALUES_H

#include <stdbool.h>

#include "image/image.h"

/* Computes coverage in [0, 1], 1 channel, from a mask's samples, 1 or 3 channels, which may be scaled: the brighter of
 * two values, or of two areas with soft edges between them, is the object; if other values lie between black and white,
 * it is what is at least half white. MERLIN_BAD_INPUT, naming the file, if more than two values have areas of their
 * own, if nothing is half white and no two values stand out, or if most of what is shown is in the middle between, as
 * in a photograph. lossy: values scatter around the intended ones. */
status mask_from_values(const char *path, img *values, bool lossy, img *mask);
/* Computes coverage from an alpha channel, which is coverage already unless it has just two values. */
status mask_from_alpha(const img *alpha, img *mask);
/* Tells whether all values are the same, so that they show no object: an unused alpha channel, say. */
bool mask_is_even(const img *values);

#endif
