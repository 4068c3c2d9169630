/* SPDX-License-Identifier: MIT */
/* The picture of maps under their own photograph's light, for maps that were read from a folder and have none. */
#ifndef MERLIN_ESTIMATE_RELIGHT_RECONSTRUCT_H
#define MERLIN_ESTIMATE_RELIGHT_RECONSTRUCT_H

#include "base/status.h"
#include "merlin/merlin.h"

/* Relights maps by the light that was estimated, by the flash and the estimated surroundings, or by the flash. */
status maps_reconstruct(merlin_model *model, const merlin_maps *maps, merlin_image *out);

#endif
