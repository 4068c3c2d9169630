/* SPDX-License-Identifier: MIT */
/* Fills pixels that have no value from those that do, by the pull-push algorithm of Gortler et al. 1996. */
#ifndef MERLIN_ESTIMATE_SURFACE_FILL_H
#define MERLIN_ESTIMATE_SURFACE_FILL_H

#include "image/image.h"

/* Replaces the image where mask (1 channel, same size) is below 0.5 by a smooth continuation of the rest, which is
 * unchanged. An empty mask gives zeros. */
status fill_outside(img *image, const img *mask);

#endif
