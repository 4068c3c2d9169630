/* SPDX-License-Identifier: MIT */
/* Raw pictures of floats: DNGs that programs make from several exposures, or from a picture that is already
 * demosaicked. LibRaw without zlib cannot read deflated ones, as nearly all are, and it scales others by their content.
 */
#ifndef MERLIN_IMAGE_FORMATS_PICTURE_DNG_H
#define MERLIN_IMAGE_FORMATS_PICTURE_DNG_H

#include "image/formats/picture.h"

/* Tells whether a file is one. */
bool picture_is_float_dng(const char *path);
/* Reads as picture_read_raw does, except that values above 1, which such pictures may have, are kept. color NULL: the
 * header alone. */
status picture_read_float_dng(const char *path, picture_colour how, img *color, picture_head *head);

#endif
