/* SPDX-License-Identifier: MIT */
/* Mean differences between successive frames, at a grid of pixels where the object looks the same. */
#ifndef MERLIN_SEQUENCE_FLICKER_METER_H
#define MERLIN_SEQUENCE_FLICKER_METER_H

#include <stdbool.h>

#include "base/status.h"
#include "merlin/sequences.h"

enum { FLICKER_MAPS = 8 }; /* albedo, normal, roughness, depth */

/* One pixel of a frame; [0]: as the frame's own, [1]: as returned. */
typedef struct flicker_sample {
    float photo[2], mask[2], maps[2][FLICKER_MAPS];
} flicker_sample;

typedef struct flicker_meter {
    int width, height, step; /* of the frames, and of the grid */
    size_t count;
    flicker_sample *last, *now;
    bool has_last;
    long pairs;
    double sums[2][6], pixels; /* photo, albedo, normal, roughness, depth, mask */
} flicker_meter;

/* Prepares for frames of this size, unless it is. */
status flicker_meter_begin(flicker_meter *m, int width, int height);
/* Take the values of the frame at hand; `after` as for a sample. */
void flicker_meter_take_photo(flicker_meter *m, const merlin_image *photo, bool after);
void flicker_meter_take_maps(flicker_meter *m, const merlin_maps *maps, bool after);
/* Compares it with the frame before, and keeps it. same: where the picture is as before, but for a shift by whole
 * pixels; NULL: nowhere. */
void flicker_meter_end(flicker_meter *m, const merlin_image *same, const int shift[2]);
void flicker_meter_read(const flicker_meter *m, merlin_flicker *out);
void flicker_meter_free(flicker_meter *m);

#endif
