/* SPDX-License-Identifier: MIT */
/* Result of a network for a photograph. */
#ifndef MERLIN_ESTIMATE_SURFACE_ESTIMATION_H
#define MERLIN_ESTIMATE_SURFACE_ESTIMATION_H

#include "estimate/surface/surface.h"
#include "image/image.h"
#include "model/model.h"

typedef struct network_estimation {
    surface maps;
    img indirect; /* light of bounces 2 and up, estimated from one view; zero for a model without global illumination.
                   * Empty for several views, whose mean has other highlights: use network_indirect */
    float environment[9][3]; /* environment of the photograph (optics/sh.h), by models of setting B; zero for others */
    float lights[MODEL_LIGHTS]; /* lights of the photograph, by models of any light (model.h); zero for others */
    img spread; /* of several photographs: half the angle between normals from two halves of them, 1 channel, degrees;
                 * empty where they are seen together (network_spread_several) */
    img visibility; /* visibility of the strongest lamp, by the same models, 1 channel in [0, 1]; empty for others */
} network_estimation;

#endif
