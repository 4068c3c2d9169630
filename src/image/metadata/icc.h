/* SPDX-License-Identifier: MIT */
/* What an ICC profile says, as far as it is needed beside libvips, which applies profiles to whole numbers alone.
 *
 *     picture_light light;
 *     if (icc_channels(profile, size) == 3 && icc_light(profile, size, &light)) ... floats by light ...
 *
 * Strangers' bytes: whatever lies outside of the profile, or is not known, says nothing. */
#ifndef MERLIN_IMAGE_METADATA_ICC_H
#define MERLIN_IMAGE_METADATA_ICC_H

#include <stddef.h>

#include "image/metadata/picture_light.h"

/* The number of channels that a profile is for: 1 (grey), 3 or 4; 0 of what is no profile. */
int icc_channels(const void *profile, size_t size);

/* Finds primaries and curve of a profile of three primaries and a curve that is linear, sRGB's or a power (ICC.1, 8.3.3
 * and 10.6, 10.18). False for all others, tables and cameras' profiles among them. */
bool icc_light(const void *profile, size_t size, picture_light *out);

#endif
