/* SPDX-License-Identifier: MIT */
/* A picture's embedded colour profile, applied by libvips to whole numbers: samples become sRGB of 16 bits.
 *
 *     VipsImage *made;
 *     if (profile_is_fit(image) && profile_apply(image, &made)) ... made instead of image ...  */
#ifndef MERLIN_IMAGE_METADATA_PROFILE_H
#define MERLIN_IMAGE_METADATA_PROFILE_H

#include "image/metadata/picture_light.h"
#include "image/vips_library.h"

/* Whether the picture has a profile for as many channels as it has colours; a grey picture's may be one of colours. */
bool profile_is_fit(VipsImage *image);

/* Colours by the profile, alpha as it is; false without memory, or where the profile is damaged. */
bool profile_apply(VipsImage *image, VipsImage **out);

/* What a profile says of floats: MERLIN_BAD_INPUT where it cannot be told (icc.h). */
status profile_light(VipsImage *image, const char *path, picture_light *out);

#endif
