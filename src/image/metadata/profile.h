/* SPDX-License-Identifier: MIT */
/* A picture's embedded colour profile, applied to integers by libvips: samples become 16-bit sRGB.
 *
 *     VipsImage *made;
 *     if (profile_is_fit(image) && profile_apply(image, &made)) ... made instead of image ...
 */
#ifndef MERLIN_IMAGE_METADATA_PROFILE_H
#define MERLIN_IMAGE_METADATA_PROFILE_H

#include "image/metadata/picture_light.h"
#include "image/vips_library.h"

/* Tells whether the picture has a profile for its number of colour channels; a grey picture's may be for three. */
bool profile_is_fit(VipsImage *image);

/* Converts the colours by the profile and keeps alpha; returns false without memory, or if the profile is damaged. */
bool profile_apply(VipsImage *image, VipsImage **out);

/* Finds what a profile says about floats: MERLIN_BAD_INPUT if that is not supported (icc.h). */
status profile_light(VipsImage *image, const char *path, picture_light *out);

#endif
