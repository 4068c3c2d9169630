/* SPDX-License-Identifier: MIT */
/* The crop of a sequence's frames: it moves with the object, and otherwise only if it must. */
#ifndef MERLIN_SEQUENCE_SEQUENCE_CROP_H
#define MERLIN_SEQUENCE_SEQUENCE_CROP_H

#include <stdbool.h>

#include "estimate/surface/crop.h"
#include "sequence/sequence_align.h"

typedef struct sequence_crop {
    bool begun;
    float x, y, side; /* moving average of the middle and the side */
    crop_square held; /* square in use */
} sequence_crop;

/* Chooses the next frame's square. mask: the object; shift: how far it moved; share: that of a new frame in the moving
 * average, in (0, 1]. MERLIN_BAD_INPUT for a mask that is too small. */
status sequence_crop_next(sequence_crop *c, const img *mask, sequence_shift shift, float share);

#endif
