/* SPDX-License-Identifier: MIT */
/* Pictures brought to another size: a photograph to one that a page can show, a mask that was painted on that back. */
#ifndef MERLIN_SERVE_JOBS_RESIZED_H
#define MERLIN_SERVE_JOBS_RESIZED_H

#include "base/status.h"
#include "merlin/image.h"

/* Makes a copy of at most `side` pixels a side, each the mean of a block. */
status resized_reduce(const merlin_image *image, int side, merlin_image *out);
/* Enlarges a picture of the same shape, up to rounding, to another's size by linear interpolation, in place; one that
 * has the size is left as it is. MERLIN_BAD_INPUT where the shapes differ, or it is larger. */
status resized_enlarge(merlin_image *mask, int width, int height);

#endif
