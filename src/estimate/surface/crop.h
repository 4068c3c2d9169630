/* SPDX-License-Identifier: MIT */
/* The square part of a photograph that the network sees.
 *
 * In the training data the object fills 25 to 75 % of a square frame, and its bounding box about 80 % of the side; a
 * photograph is cropped to look like that. A square photograph that already looks like that is used whole. */
#ifndef MERLIN_ESTIMATE_SURFACE_CROP_H
#define MERLIN_ESTIMATE_SURFACE_CROP_H

#include <stdbool.h>

#include "image/image.h"

typedef struct crop_square {
    int x, y, side; /* pixels of the photograph; the square may extend beyond its edges */
} crop_square;

/* Tells whether a square can be a photograph's, no part of it beyond CROP_FARTHEST; squares read from files may be any
 * numbers. */
enum { CROP_FARTHEST = 65536 };
bool crop_is_sound(crop_square c);

/* Chooses the square around the object. mask: 1 channel; a pixel belongs to the object from 0.5 on. MERLIN_BAD_INPUT if
 * fewer than 64 pixels do. */
status crop_around(const img *mask, crop_square *out);

/* Tells whether the object lies in the square, up to `slack` pixels beyond each side, and is at least as long as this
 * share of the square's side. */
bool crop_holds(const img *mask, crop_square c, int slack, float least_share);

/* Copy the square out of an image of the photograph's size, with zeros beyond its edges, and back into a zeroed image
 * of that size (`to` has from's channels). cover: a mask of from's size; values outside its rows' spans (img_row_span)
 * stay zero. NULL: all values are copied. */
status crop_take(const img *from, crop_square c, const img *cover, img *out);
void crop_put(const img *from, crop_square c, const img *cover, img *to);

#endif
