/* SPDX-License-Identifier: MIT */
/* The reflection of an environment on a surface.
 *
 *     surface_add_reflections(&maps, &env, NULL, &image);   image += the specular lobe over the map
 *
 * The result is nearly that of lobe_sampler.h at every pixel. Where normals, lines of sight and the horizon vary little
 * compared with the width of the lobe, it is evaluated at the corners of squares of 16, 8 or 4 pixels, for a few
 * roughnesses, and interpolated to each pixel's place and roughness. The error in a square's middle decides whether
 * that suffices; otherwise, and at outlines, every pixel is evaluated. */
#ifndef MERLIN_ESTIMATE_LIGHT_REFLECTIONS_H
#define MERLIN_ESTIMATE_LIGHT_REFLECTIONS_H

#include "estimate/light/env_map.h"
#include "estimate/light/horizon.h"
#include "estimate/surface/surface.h"

/* Adds the reflection, times coverage and before clipping, to image: 3 channels of the surface's size. h: the horizon
 * that hides a part of the environment, or NULL. */
void surface_add_reflections(const surface *s, const env_map *env, const horizon *h, img *image);

#endif
