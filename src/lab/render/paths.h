/* SPDX-License-Identifier: MIT */
/* Light reaching a visible point: straight from a point light, by way of other surfaces, or from an environment.
 *
 * Paths are drawn from the mixture of both lobes of the BRDF; at every surface they meet, the light is sampled on its
 * own (next-event estimation). Every function is a pure function of its arguments and of the generator it advances. */
#ifndef MERLIN_LAB_RENDER_PATHS_H
#define MERLIN_LAB_RENDER_PATHS_H

#include "base/rng.h"
#include "lab/render/environment.h"
#include "lab/render/path_packet.h"
#include "lab/render/sequence.h"
#include "lab/render/trace.h"

/* Radiance that a single path may bring by way of another surface, per bounce and channel. Rare paths of tiny
 * probability would otherwise leave bright dots; what is cut is below 1 % of the indirect light of ordinary objects.
 * What the first surface gets from an environment is not cut: a lamp's highlight is paths that bring more. */
#define PATH_CLAMP ((real)4)

/* A lamp; a point, or a disc whose parts a surface sees one by one. */
typedef struct point_light {
    vec3 position;
    real power;
    bool at_eye;    /* a flash: whatever the camera sees is lit, so no shadow rays from there */
    vec3 across[2]; /* from the middle of a disc to its edge, two ways at a right angle; of a point both zero */
} point_light;

/* What decides a path: numbers of the sequence at its first surfaces, where they matter most, and random ones behind.
 */
typedef struct path_source {
    const sequence *sequence;
    rng *random;
} path_source;

/* Bounce 1: radiance of points toward their views, without looking for shadows. */
void point_light_unshadowed(trace_scene *scene, const scene_surface *at, const vec3 *view, int count,
                            const point_light *light, vec3 *radiance);
/* The same, less what other surfaces, or the surface's own back, keep of the lamp's parts. */
void point_light_direct(trace_scene *scene, const scene_surface *at, const vec3 *view, int count,
                        const point_light *light, vec3 *radiance);
/* Both at once, by the same parts: what arrives, and what would if nothing were in the way. */
void point_light_both(trace_scene *scene, const scene_surface *at, const vec3 *view, int count,
                      const point_light *light, vec3 *radiance, vec3 *unshadowed);
/* Bounces 2 and 3 for each of `count` pixels, the sums over so many paths each. */
void point_light_paths(trace_scene *scene, const path_points *pixels, int count, const point_light *light,
                       const path_source *source, int paths, vec3 (*bounce)[2]);

/* Radiance from the environment for each of `count` pixels, the sums over so many paths each, of at most three
 * surfaces; both the map and the BRDF are sampled and combined by the balance heuristic (Veach & Guibas 1995). */
void environment_paths(trace_scene *scene, const path_points *pixels, int count, const environment *env,
                       const path_source *source, int paths, vec3 *radiance);

#endif
