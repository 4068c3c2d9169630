/* SPDX-License-Identifier: MIT */
/* An object's movement between two frames, by whole pixels. */
#ifndef MERLIN_SEQUENCE_SEQUENCE_ALIGN_H
#define MERLIN_SEQUENCE_SEQUENCE_ALIGN_H

#include "image/image.h"

typedef struct sequence_shift {
    int x, y; /* pixels to the right and down */
} sequence_shift;

/* Finds the shift at which the pictures differ least within the mask, which belongs to `before`: coarse to fine, up to
 * a twelfth of the mask's size around `expected`, and none unless another is clearly better. before, now: 1 channel;
 * mask: 1 channel, the object from 0.5 on; all of one size. */
status sequence_align(const img *before, const img *now, const img *mask, sequence_shift expected, sequence_shift *out);

/* Moves an image, in place; what comes from beyond the edges is zero. */
status sequence_move(img *image, sequence_shift by);

#endif
