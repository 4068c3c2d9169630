/* SPDX-License-Identifier: MIT */
/* A capture with fewer, larger pixels: what slow searches start on, and what evaluation brings large ones to.
 *
 *     merlin_capture small;
 *     status s = pst_shrink(&capture, pst_blocks_of(&capture, 4), PST_SATURATED, &small);
 *     ... find its depth ...
 *     pst_enlarge(&depth, &small.mask, &capture.mask, 4, &out);
 *     pst_capture_free(&small); */
#ifndef MERLIN_STEREO_CAPTURE_SHRINK_H
#define MERLIN_STEREO_CAPTURE_SHRINK_H

#include "stereo/capture/capture.h"

/* Which pixels become one: columns × rows blocks of factor × factor, the first at (x, y). They may hang over the edges.
 */
typedef struct pst_blocks {
    int x, y, columns, rows, factor;
    bool whole; /* on the object is what lies on it wholly; else what holds a pixel of it */
} pst_blocks;

/* The whole picture's. */
pst_blocks pst_blocks_of(const merlin_capture *c, int factor);

/* Every pixel the mean of its block's pixels on the object. A channel of which one reaches the share `saturation` of
 * full scale is saturated itself, as it would be on a sensor; whether the others count still is for the solvers to say.
 * Names and truth are left out. */
status pst_shrink(const merlin_capture *c, pst_blocks blocks, float saturation, merlin_capture *out);

/* Shrinks a capture to about so many pixels of the object, at most four times as many, and to at most so many of its
 * pictures, spread evenly; picture gets their numbers. The lights are those of these. */
status pst_shrink_to(const merlin_capture *c, int pixels, int most_pictures, int picture[], merlin_capture *out);

/* Values between the means of 1 channel, for the pixels of mask that the small mask covers; out has the mask's size. */
void pst_enlarge(const img *small, const img *small_mask, const img *mask, int factor, img *out);

#endif
