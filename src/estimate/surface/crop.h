/* SPDX-License-Identifier: MIT */
/* The square of a photograph that the network sees.
 *
 * In the training data the object fills 25 to 75 % of a square frame, its bounding box about 80 % of the side; a
 * photograph is cropped to look like that. A square photograph that is framed like that already is taken whole. */
#ifndef MERLIN_ESTIMATE_SURFACE_CROP_H
#define MERLIN_ESTIMATE_SURFACE_CROP_H

#include <stdbool.h>

#include "image/image.h"

typedef struct crop_square {
    int x, y, side; /* pixels of the photograph; may hang over its edges */
} crop_square;

/* Whether it can be a photograph's, nothing of it beyond CROP_FARTHEST: what came from outside may be any numbers. */
enum { CROP_FARTHEST = 65536 };
bool crop_is_sound(crop_square c);

/* mask: 1 channel; a pixel belongs to the object from 0.5 on. MERLIN_BAD_INPUT if fewer than 64 pixels do. */
status crop_around(const img *mask, crop_square *out);

/* Tells whether the object lies in the square, but for `slack` pixels a side, and is at least as long as this share of
 * the square's side. */
bool crop_holds(const img *mask, crop_square c, int slack, float least_share);

/* The crop out of an image of the photograph's size, zero where it hangs over; and back into a zeroed image of that
 * size (`to` has from's channels). cover: a mask of from's size; what is beside its rows' spans (img_row_span) stays
 * zero. NULL: all of it is taken. */
status crop_take(const img *from, crop_square c, const img *cover, img *out);
void crop_put(const img *from, crop_square c, const img *cover, img *to);

#endif
