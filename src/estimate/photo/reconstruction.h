/* SPDX-License-Identifier: MIT */
/* A photograph rendered by its own maps, under the light it was taken in. */
#ifndef MERLIN_ESTIMATE_PHOTO_RECONSTRUCTION_H
#define MERLIN_ESTIMATE_PHOTO_RECONSTRUCTION_H

#include <stdbool.h>

#include "estimate/surface/estimation.h"
#include "merlin/estimate.h"

typedef struct reconstruction {
    const surface *maps;                 /* of the crop's size */
    const network_estimation *estimated; /* bounces, environment and the lamp's visibility, of the network's size */
    const img *estimated_mask, *mask;    /* of these sizes */
    const merlin_found_light *light;     /* not known: the flash, */
    bool in_environment;                 /* and the estimated environment */
    float white;                         /* radiance that becomes 1 */
} reconstruction;

/* Renders 3 channels in [0, 1], of the crop's size. MERLIN_NO_MEMORY. */
status reconstruction_render(const reconstruction *r, img *out);

#endif
