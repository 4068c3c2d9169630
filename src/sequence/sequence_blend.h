/* SPDX-License-Identifier: MIT */
/* The moving average of maps, where the picture has not changed. */
#ifndef MERLIN_SEQUENCE_SEQUENCE_BLEND_H
#define MERLIN_SEQUENCE_SEQUENCE_BLEND_H

#include <stdbool.h>

#include "merlin/maps.h"
#include "sequence/sequence_align.h"

/* Averages of the frames before, at the places where the object is now. */
typedef struct sequence_history {
    img albedo, normal, roughness, depth, mask, reconstruction; /* averages */
    img seen;                                                   /* average picture, encoded and exposed */
    float unit; /* factor of a photograph's light before it is encoded, by which white is about 1 */
    img weight; /* number of frames in the average, by pixel */
    merlin_found_light light;
} sequence_history;

void sequence_history_free(sequence_history *h);
status sequence_history_move(sequence_history *h, sequence_shift by);

/* Tells at which pixels the picture is that of before: 1 where it is, 0 where it is not. now: encoded, in that unit,
 * and exposed. It is judged by the mean over a few pixels and by each itself, relative to the noise. *difference: the
 * median difference within the mask of before. */
status sequence_sameness(const sequence_history *h, const img *now, img *same, float *difference);

/* Replaces the maps by the average of them and the history, which is updated. same NULL: there is none. most: number of
 * frames that count. keep_mask: the frame's mask is right as it is. *kept: share of the object's pixels at which the
 * average went on. */
status sequence_blend(sequence_history *h, const img *now, const img *same, int most, bool keep_mask, merlin_maps *maps,
                      float *kept);

#endif
