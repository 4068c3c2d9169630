/* SPDX-License-Identifier: MIT */
/* What a surface mirrors of its surroundings.
 *
 *     surface_add_reflections(&maps, &env, NULL, &image);   image += the specular lobe over the map
 *
 * lobe.h at every pixel, or as good as that: where normals, lines of sight and what the horizon hides vary little
 * against the width of the lobe, it is worked out at the corners of squares of 16, 8 or 4 pixels, for a few
 * roughnesses, and interpolated to each pixel's place and own roughness. A square's middle tells whether that will do;
 * where not, and at outlines, every pixel is worked out. */
#ifndef MERLIN_ESTIMATE_LIGHT_REFLECTIONS_H
#define MERLIN_ESTIMATE_LIGHT_REFLECTIONS_H

#include "estimate/light/env_map.h"
#include "estimate/light/horizon.h"
#include "estimate/surface/surface.h"

/* Times coverage and before clipping, added to image: 3 channels of the surface's size. h: hides some of the
 * surroundings; or NULL. */
void surface_add_reflections(const surface *s, const env_map *env, const horizon *h, img *image);

#endif
