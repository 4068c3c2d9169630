/* SPDX-License-Identifier: MIT */
/* Reduces a capture to fewer, larger pixels, on which slow searches start and large captures are evaluated.
 *
 *     merlin_capture small;
 *     status s = pst_shrink(&capture, pst_blocks_of(&capture, 4), PST_SATURATED, &small);
 *     ... find its depth ...
 *     pst_enlarge(&depth, &small.mask, &capture.mask, 4, &out);
 *     pst_capture_free(&small);
 */
#ifndef MERLIN_STEREO_CAPTURE_SHRINK_H
#define MERLIN_STEREO_CAPTURE_SHRINK_H

#include "stereo/capture/capture.h"

/* Blocks of pixels that become one: columns × rows of factor × factor, the first at (x, y). They may extend beyond the
 * edges. */
typedef struct pst_blocks {
    int x, y, columns, rows, factor;
    bool whole; /* whether only blocks completely on the object count as object, or those with any pixel of it */
} pst_blocks;

/* Returns the blocks of the whole picture. */
pst_blocks pst_blocks_of(const merlin_capture *c, int factor);

/* Makes every pixel the mean of its block's pixels on the object. A channel of which one pixel reaches the share
 * `saturation` of full scale is saturated, as it would be on a sensor; solvers decide whether the others still count.
 * Names and ground truth are omitted. */
status pst_shrink(const merlin_capture *c, pst_blocks blocks, float saturation, merlin_capture *out);

/* Makes a map's pixels the mean over the pixels of their block on the mask, 0 where there are none. */
status pst_shrink_map(const img *map, const img *mask, pst_blocks blocks, img *out);

/* Shrinks a capture to about this number of the object's pixels, at most four times as many, and to at most this number
 * of pictures, spread evenly; picture gets their indices. The lights are those of these pictures. */
status pst_shrink_to(const merlin_capture *c, int pixels, int most_pictures, int picture[], merlin_capture *out);

/* Interpolates 1 channel for the pixels of mask that the small mask covers; out has the mask's size. */
void pst_enlarge(const img *small, const img *small_mask, const img *mask, int factor, img *out);

#endif
