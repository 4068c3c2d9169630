/* SPDX-License-Identifier: MIT */
/* Simple formats that are read here by their specifications, a row at a time: netpbm's, BMP and TGA. Each reader parses
 * the header and then returns the rows in the file's order; the layout says which way up they are.
 *
 *     status s = picture_read_plain("a.tga", PICTURE_TGA, PICTURE_LINEARIZE, &color, &alpha, &head);
 */
#ifndef MERLIN_IMAGE_PLAIN_PICTURE_PLAIN_H
#define MERLIN_IMAGE_PLAIN_PICTURE_PLAIN_H

#include "image/formats/picture.h"

/* Reads a picture. color NULL: the header alone. alpha may be NULL; one that is 0 everywhere is taken as unused and
 * left out. */
status picture_read_plain(const char *path, picture_kind kind, picture_colour how, img *color, img *alpha,
                          picture_head *head);

#endif
