/* SPDX-License-Identifier: MIT */
/* Where coverage, 1 channel in [0, 1], has an object, and whether it says anything of that. */
#ifndef MERLIN_IMAGE_COVERAGE_H
#define MERLIN_IMAGE_COVERAGE_H

#include <stdbool.h>

#include "image/image.h"

/* From this on a value counts as 1: masks that went through JPEG have clean insides then. */
#define COVERAGE_WHOLE 0.95f

/* Tells whether it is 1 everywhere, which says nothing. */
bool coverage_is_opaque(const img *mask);
/* Tells whether it is less than half everywhere, which shows nothing. */
bool coverage_is_transparent(const img *mask);

/* The smallest box around the pixels that are covered by half or more, and their number. Columns left to right and rows
 * top to bottom, without the latter; of no pixels it is empty, with right before left. */
typedef struct coverage_box {
    int left, top, right, bottom;
    size_t pixels;
} coverage_box;
coverage_box coverage_box_of(const img *mask);

/* Returns the share of the picture's edge where half or more is covered. */
float coverage_of_edge(const img *mask);

#endif
