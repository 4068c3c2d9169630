/* SPDX-License-Identifier: MIT */
/* Raw pictures of floats: DNGs that programs make of several exposures, or of a picture that they have mosaicked no
 * more. LibRaw does not read those that are deflated, as nearly all are, where it was built without zlib, and scales
 * others by what they show. */
#ifndef MERLIN_IMAGE_FORMATS_PICTURE_DNG_H
#define MERLIN_IMAGE_FORMATS_PICTURE_DNG_H

#include "image/formats/picture.h"

/* Tells whether a file is one. */
bool picture_is_float_dng(const char *path);
/* As picture_read_raw, but for values above 1, which such a picture may have. color NULL: the head alone. */
status picture_read_float_dng(const char *path, picture_colour how, img *color, picture_head *head);

#endif
