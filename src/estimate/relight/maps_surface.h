/* SPDX-License-Identifier: MIT */
/* The public maps of a photograph as the surface in its crop. */
#ifndef MERLIN_ESTIMATE_RELIGHT_MAPS_SURFACE_H
#define MERLIN_ESTIMATE_RELIGHT_MAPS_SURFACE_H

#include "estimate/surface/crop.h"
#include "estimate/surface/surface.h"
#include "merlin/merlin.h"

static inline crop_square crop_of(const merlin_maps *maps)
{
    return (crop_square){maps->crop.x, maps->crop.y, maps->crop.side};
}

/* MERLIN_WRONG_USE if the maps are not what merlin_estimate or merlin_maps_read gave. */
status maps_check(const merlin_maps *maps);

/* The maps of the crop, brought to side × side pixels, their mask 0 or 1. */
status maps_surface(const merlin_maps *maps, int side, surface *out);
/* Their albedo alone; enlarged, it may be zero beside the object. */
status maps_albedo(const merlin_maps *maps, int side, img *out);

/* The parts of that, for who takes several: the mask of the crop; the maps at the photograph's own size; and brought to
 * side × side pixels, mask being maps_take_mask's and hard: the mask of 0 or 1. */
status maps_take_mask(const merlin_maps *maps, img *out);
status maps_as_photographed(const merlin_maps *maps, surface *out);
status maps_take_surface(const merlin_maps *maps, const img *mask, int side, bool hard, surface *out);

#endif
