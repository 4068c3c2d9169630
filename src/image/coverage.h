/* SPDX-License-Identifier: MIT */
/* Tells whether coverage, 1 channel in [0, 1], says anything of what is an object and what is not. */
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

#endif
