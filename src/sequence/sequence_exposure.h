/* SPDX-License-Identifier: MIT */
/* Brightness and white balance of frames, relative to the frames before. */
#ifndef MERLIN_SEQUENCE_SEQUENCE_EXPOSURE_H
#define MERLIN_SEQUENCE_SEQUENCE_EXPOSURE_H

#include "image/image.h"
#include "sequence/sequence_align.h"

/* Encodes a linear picture for comparisons by a square root, in which noise is about the same at all brightnesses. */
status sequence_encode(const img *photo, img *out);
/* Multiplies the light of an encoded picture. */
void sequence_scale(img *encoded, const float factor[3]);
/* Returns the mean of an encoded picture's channels, times a factor of the light. */
status sequence_grey(const img *encoded, float factor, img *out);

/* Returns the factor of the light that makes `now` as bright as `before` within the mask of the latter, which has moved
 * by this. */
float sequence_brightness(const img *before, const img *now, const img *mask, sequence_shift by);
/* Finds the same for each channel, by the medians over pixels that lie at the same places. */
void sequence_factors(const img *before, const img *now, const img *mask, float factor[3]);
/* Multiplies a photograph. What was white stays white, and nothing else becomes it, as white counts as burnt out; only
 * a photograph with values above white has no such limit. */
void sequence_expose(img *photo, const float factor[3]);

/* Returns the median of the values, whose order is changed; 0 of none. */
float sequence_median(float *values, size_t count);

#endif
