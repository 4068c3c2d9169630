/* SPDX-License-Identifier: MIT */
/* A surface under an environment: diffuse by its spherical harmonics, highlights from the map itself or, where only the
 * coefficients are known, from these.
 *
 *     surface_add_ambient(&maps, env.sh, &image);           image += albedo/π · irradiance
 *     surface_add_reflections(&maps, &env, NULL, &image);   reflections.h
 *
 * All of it is times coverage and before clipping. image: 3 channels of the surface's size. The surface shades itself
 * if its horizon is given:
 *
 *     status s = surface_add_shadowed_environment(&maps, &maps, &horizon, &env, &image); */
#ifndef MERLIN_ESTIMATE_LIGHT_RELIGHT_ENV_H
#define MERLIN_ESTIMATE_LIGHT_RELIGHT_ENV_H

#include "estimate/light/reflections.h"

/* Light that never is below zero, though three bands of a bright sky may be. */
void surface_add_ambient(const surface *s, const float sh[9][3], img *image);

/* Of the irradiance on every pixel, by channel: the share that arrives past the surface itself, as env_lights.h tells
 * it, and by one bounce from nearby; in [0, 1], continued off the surface. share is made here, of the surface's size.
 */
status surface_arriving_light(const surface *s, const horizon *h, const env_map *env, img *share);

/* Ambient light times that share, and reflections past the horizon. coarse: the same surface at the size for which the
 * share is worked out. */
status surface_add_shadowed_environment(const surface *s, const surface *coarse, const horizon *h, const env_map *env,
                                        img *image);

/* optics/ambient.h. */
void surface_add_ambient_highlights(const surface *s, const float sh[9][3], img *image);

#endif
