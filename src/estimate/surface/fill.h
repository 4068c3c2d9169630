/* SPDX-License-Identifier: MIT */
/* Values for the pixels that have none, from those that do: the pull-push of Gortler et al. 1996. */
#ifndef MERLIN_ESTIMATE_SURFACE_FILL_H
#define MERLIN_ESTIMATE_SURFACE_FILL_H

#include "image/image.h"

/* Replaces image where mask (1 channel, same size) is below 0.5 by a smooth continuation of the rest, which stays
 * untouched. An empty mask gives zeros. */
status fill_outside(img *image, const img *mask);

#endif
