/* SPDX-License-Identifier: MIT */
/* Resizes pictures: a photograph for display on a page, and a mask painted on that back to the photograph's size. */
#ifndef MERLIN_SERVE_JOBS_RESIZED_H
#define MERLIN_SERVE_JOBS_RESIZED_H

#include "base/status.h"
#include "merlin/image.h"

/* Makes a copy of at most `side` pixels a side, by merlin_image_resize. */
status resized_reduce(const merlin_image *image, int side, merlin_image *out);
/* Enlarges a picture of the same aspect ratio, within rounding, to another's size by linear interpolation, in place;
 * one of that size is unchanged. MERLIN_BAD_INPUT if the ratios differ, or it is larger. */
status resized_enlarge(merlin_image *mask, int width, int height);

#endif
