/* SPDX-License-Identifier: MIT */
/* A surface lit by an environment: its diffuse part by spherical harmonics, highlights by the map itself or, if only
 * the coefficients are known, by these.
 *
 *     surface_add_ambient(&maps, env.sh, &image);           image += albedo/π · irradiance
 *     surface_add_reflections(&maps, &env, NULL, &image);   reflections.h
 *
 * All light is multiplied by coverage and not clipped. image: 3 channels of the surface's size. With its horizon the
 * surface casts shadows on itself:
 *
 *     status s = surface_add_shadowed_environment(&maps, &maps, &horizon, &env, &image);
 */
#ifndef MERLIN_ESTIMATE_LIGHT_RELIGHT_ENV_H
#define MERLIN_ESTIMATE_LIGHT_RELIGHT_ENV_H

#include "estimate/light/reflections.h"

/* Adds the diffuse light, which is never below zero although three bands of a bright sky may be. */
void surface_add_ambient(const surface *s, const float sh[9][3], img *image);

/* Computes the share of the irradiance on every pixel, by channel, that arrives past the surface itself, sampled by the
 * lights of env_lights.h, and by one bounce from nearby; in [0, 1], continued outside the surface. share is made here,
 * of the surface's size. */
status surface_arriving_light(const surface *s, const horizon *h, const env_map *env, img *share);

/* Adds ambient light times that share, and reflections limited by the horizon. coarse: the same surface at the size at
 * which the share is computed. */
status surface_add_shadowed_environment(const surface *s, const surface *coarse, const horizon *h, const env_map *env,
                                        img *image);

/* Adds the highlights of an environment known only by its coefficients (optics/ambient.h). */
void surface_add_ambient_highlights(const surface *s, const float sh[9][3], img *image);

#endif
