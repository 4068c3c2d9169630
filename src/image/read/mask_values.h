/* SPDX-License-Identifier: MIT */
/* Which of a mask's values are the object. White on black is the usual, but programs that segment write the number of a
 * label, so that the object is 1 or 15 of 255 and all but black: two values are a mask, whatever they are. */
#ifndef MERLIN_IMAGE_READ_MASK_VALUES_H
#define MERLIN_IMAGE_READ_MASK_VALUES_H

#include <stdbool.h>

#include "image/image.h"

/* Makes coverage in [0, 1], 1 channel, of a mask's samples, 1 or 3 channels, which may be scaled: the brighter of two
 * values, or of two areas with softened edges between them, is the object; with others between black and white what is
 * half white or more is. MERLIN_BAD_INPUT, naming the file, where more than two values have areas of their own, or none
 * is half white and no two stand out. lossy: values scatter about those that were meant. */
status mask_from_values(const char *path, img *values, bool lossy, img *mask);
/* The same of an alpha, which is coverage already unless it has two values alone. */
status mask_from_alpha(const img *alpha, img *mask);
/* Tells whether all values are the same, which show no object: an alpha that is not used, say. */
bool mask_is_even(const img *values);

#endif
