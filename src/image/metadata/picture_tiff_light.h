/* SPDX-License-Identifier: MIT */
/* Light of a TIFF's codes by its own tags, beside a profile. */
#ifndef MERLIN_IMAGE_METADATA_PICTURE_TIFF_LIGHT_H
#define MERLIN_IMAGE_METADATA_PICTURE_TIFF_LIGHT_H

#include "image/metadata/picture_light.h"
#include "image/metadata/tiff_head.h"

/* Reads the curve of its TransferFunction, its PrimaryChromaticities and WhitePoint (TIFF 6.0, section 20), or the
 * colour space of its EXIF; refuses a curve that is not a picture_curve. */
status picture_tiff_light(const tiff_head *t, uint64_t page, const char *path, picture_light *out);

#endif
