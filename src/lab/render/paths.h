/* SPDX-License-Identifier: MIT */
/* Light at a visible point: directly from a point light, by way of other surfaces, or from an environment.
 *
 * Paths are sampled from the mixture of both lobes of the BRDF; at every surface they hit, the light is sampled
 * separately (next-event estimation). Every function is a pure function of its arguments and of the generator it
 * advances. */
#ifndef MERLIN_LAB_RENDER_PATHS_H
#define MERLIN_LAB_RENDER_PATHS_H

#include "base/rng.h"
#include "lab/render/environment.h"
#include "lab/render/path_packet.h"
#include "lab/render/sequence.h"
#include "lab/render/trace.h"

/* Largest radiance of a single path by way of another surface, per bounce and channel. Without it, rare paths of tiny
 * probability leave bright dots; what is cut is below 1 % of the indirect light of ordinary objects. Light from an
 * environment at the first surface is not cut: a lamp's highlight consists of brighter paths. */
#define PATH_CLAMP ((real)4)

/* A lamp: a point, or a disc that is tested for shadows in parts; either may be an LED. */
typedef struct point_light {
    vec3 position;
    real power;     /* Φ; of an LED, on its axis */
    bool at_eye;    /* a flash: everything the camera sees is lit, so that no shadow rays are needed */
    vec3 across[2]; /* from the middle of a disc to its edge, in two perpendicular directions; both zero for a point */
    vec3 axis;      /* of an LED: unit; else zero */
    real lobe;      /* of an LED: exponent (optics/led.h) */
} point_light;

/* Source of a path's numbers: the sequence at its first surfaces, where they matter most, and random numbers after. */
typedef struct path_source {
    const sequence *sequence;
    rng *random;
} path_source;

/* Computes bounce 1: radiance of points toward their views, without shadows. */
void point_light_unshadowed(trace_scene *scene, const scene_surface *at, const vec3 *view, int count,
                            const point_light *light, vec3 *radiance);
/* Computes bounce 1 with shadows cast by other surfaces and by the surface's own back. */
void point_light_direct(trace_scene *scene, const scene_surface *at, const vec3 *view, int count,
                        const point_light *light, vec3 *radiance);
/* Computes both at once, testing the same points of the lamp: with shadows and without. */
void point_light_both(trace_scene *scene, const scene_surface *at, const vec3 *view, int count,
                      const point_light *light, vec3 *radiance, vec3 *unshadowed);
/* Computes bounces 2 and 3 for each of `count` pixels, summed over `paths` paths each. */
void point_light_paths(trace_scene *scene, const path_points *pixels, int count, const point_light *light,
                       const path_source *source, int paths, vec3 (*bounce)[2]);

/* Computes radiance from the environment for each of `count` pixels, summed over `paths` paths each, of at most three
 * surfaces; samples of the map and of the BRDF are combined by the balance heuristic (Veach & Guibas 1995). */
void environment_paths(trace_scene *scene, const path_points *pixels, int count, const environment *env,
                       const path_source *source, int paths, vec3 *radiance);

#endif
