/* SPDX-License-Identifier: MIT */
/* The parts of ICC profiles that are needed beside libvips, which applies profiles to integers only.
 *
 *     picture_light light;
 *     if (icc_channels(profile, size) == 3 && icc_light(profile, size, &light)) ... floats by light ...
 *
 * Profiles are not trusted: positions outside the profile, and unknown types, count as missing. */
#ifndef MERLIN_IMAGE_METADATA_ICC_H
#define MERLIN_IMAGE_METADATA_ICC_H

#include <stddef.h>

#include "image/metadata/picture_light.h"

/* Returns the number of channels that a profile is for: 1 (grey), 3 or 4; 0 if it is not a profile. */
int icc_channels(const void *profile, size_t size);

/* Reads primaries and curve of a profile with three primaries and one curve that is linear, sRGB's or a power (ICC.1,
 * 8.3.3 and 10.6, 10.18). Returns false for all others, among them tables and cameras' profiles. */
bool icc_light(const void *profile, size_t size, picture_light *out);

#endif
