/* SPDX-License-Identifier: MIT */
/* Chooses the frames of a video whose light differs most.
 *
 *     frame_looks looks = {0};
 *     while (... more frames ...) s = frame_looks_add(&looks, &frame);
 *     size_t chosen[16], count;
 *     s = frame_looks_choose(&looks, 16, chosen, &count);
 *     frame_looks_free(&looks);
 *
 * A frame's look is its brightness in 24×24 cells, of unit length, so that neither exposure nor a lamp's strength
 * counts. Two frames differ by the distance of their looks, from 0 to 2. Of a long video, every second, fourth, ...
 * frame is considered, so that memory is limited. */
#ifndef MERLIN_STEREO_CAPTURE_FRAME_CHOICE_H
#define MERLIN_STEREO_CAPTURE_FRAME_CHOICE_H

#include "image/image.h"

typedef struct frame_looks {
    float *look;        /* count looks */
    float *level;       /* their mean brightness */
    size_t count, room; /* of the frames that are considered */
    size_t seen, step;  /* number of frames, of which every step-th is considered */
} frame_looks;

/* Takes the next frame, of 3 channels. */
status frame_looks_add(frame_looks *looks, const img *frame);
/* Chooses at most `most` frames, and writes their numbers, the first of the video being 0, in ascending order: a bright
 * one, then always the one that differs most from those chosen, until none does. Dark frames, which hardly show where a
 * light is, are left out. */
status frame_looks_choose(const frame_looks *looks, size_t most, size_t chosen[], size_t *count);
void frame_looks_free(frame_looks *looks);

#endif
