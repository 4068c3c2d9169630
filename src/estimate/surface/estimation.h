/* SPDX-License-Identifier: MIT */
/* A network's answers about a photograph. */
#ifndef MERLIN_ESTIMATE_SURFACE_ESTIMATION_H
#define MERLIN_ESTIMATE_SURFACE_ESTIMATION_H

#include "estimate/surface/surface.h"
#include "image/image.h"
#include "model/model.h"

typedef struct network_estimation {
    surface maps;
    img indirect; /* of one view: light of bounces 2 and up; zero for a model without global illumination. The mean of
                     more views has highlights of its own: empty here, to be asked of network_indirect */
    float environment[9][3];    /* the photograph's (optics/sh.h), by models of setting B; zero for others */
    float lights[MODEL_LIGHTS]; /* what lit the photograph, by models of any light (model.h); zero for others */
    img visibility;             /* by these: of the strongest lamp, 1 channel in [0, 1]; else empty */
} network_estimation;

#endif
