/* SPDX-License-Identifier: MIT */
/* Converts the public maps of a photograph to the surface in its crop. */
#ifndef MERLIN_ESTIMATE_RELIGHT_MAPS_SURFACE_H
#define MERLIN_ESTIMATE_RELIGHT_MAPS_SURFACE_H

#include "estimate/surface/crop.h"
#include "estimate/surface/surface.h"
#include "merlin/merlin.h"

static inline crop_square crop_of(const merlin_maps *maps)
{
    return (crop_square){maps->crop.x, maps->crop.y, maps->crop.side};
}

/* Fails with MERLIN_WRONG_USE if the maps did not come from merlin_estimate or merlin_maps_read. */
status maps_check(const merlin_maps *maps);

/* Takes the maps of the crop, resized to side × side pixels, with a mask of 0 or 1. */
status maps_surface(const merlin_maps *maps, int side, surface *out);
/* Takes their albedo only; if enlarged, it may be zero outside the object. */
status maps_albedo(const merlin_maps *maps, int side, img *out);

/* Take the parts separately, for callers that need several: the mask of the crop; the maps at the photograph's own
 * size, or of these only normal, depth, mask and lens, as they are; and resized to side × side pixels, where mask is
 * that of maps_take_mask, and `hard` makes it 0 or 1. */
status maps_take_mask(const merlin_maps *maps, img *out);
status maps_as_photographed(const merlin_maps *maps, surface *out);
status maps_shape_as_photographed(const merlin_maps *maps, surface *out);
status maps_take_surface(const merlin_maps *maps, const img *mask, int side, bool hard, surface *out);

#endif
