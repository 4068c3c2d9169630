/* SPDX-License-Identifier: MIT */
/* Formats so plain that they are read here, a row at a time, as their specifications have them: netpbm's, BMP and TGA.
 * Each tells its head first and then gives its rows in the file's order; which way up they are the layout says.
 *
 *     status s = picture_read_plain("a.tga", PICTURE_TGA, PICTURE_LINEARIZE, &color, &alpha, &head);
 */
#ifndef MERLIN_IMAGE_PLAIN_PICTURE_PLAIN_H
#define MERLIN_IMAGE_PLAIN_PICTURE_PLAIN_H

#include "image/formats/picture.h"

/* color NULL: the head alone. alpha may be NULL; one that is 0 everywhere says nothing and is left out. */
status picture_read_plain(const char *path, picture_kind kind, picture_colour how, img *color, img *alpha,
                          picture_head *head);

#endif
