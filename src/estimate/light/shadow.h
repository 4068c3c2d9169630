/* SPDX-License-Identifier: MIT */
/* The shadow that a visible surface casts on itself.
 *
 *     shadow_occluder occluder;
 *     status s = shadow_occluder_new(&depth, &normal, &mask, 60, &occluder);  once per surface
 *     img seen;
 *     s = shadow_cast(&occluder, light, side, &seen);                         once per light
 *     shadow_darken(&seen, &direct);
 *     shadow_occluder_free(&occluder);
 *
 * From every pixel a ray is followed toward the light through the depth map, one pixel per step. It is blocked where it
 * runs behind the map by more than the map's own error and less than the object's thickness, which is unknown and
 * assumed to be typical; behind thinner objects rays pass to the light. Shadow borders are soft: the longer the ray,
 * the less certain is the end of the shadow of an estimated depth.
 *
 * Depth and normals are fused first (fuse.h): shadows depend on slopes, and the bumps of the depth alone would cast
 * shadows that are in no photograph. */
#ifndef MERLIN_ESTIMATE_LIGHT_SHADOW_H
#define MERLIN_ESTIMATE_LIGHT_SHADOW_H

#include "base/vec.h"
#include "image/image.h"
#include "optics/camera.h"
#include "optics/light.h"

/* Thickness of visible parts in scene units, of which an object is about one wide. It was found by trial on samples
 * with path-traced shadows (docs/notes/cast_shadows.md). */
#define SHADOW_THICKNESS 0.15f

typedef struct shadow_occluder {
    img depth; /* 1 channel, fused; continued outside the mask */
    img mask;  /* 1 channel */
    camera_lens lens;
    float nearest, farthest; /* range of depths inside the mask */
} shadow_occluder;

/* Copies a surface. depth: 1 channel, normal: 3, mask: 1, all of one size; mask values from 0.5 on are surface. */
status shadow_occluder_new(const img *depth, const img *normal, const img *mask, camera_lens lens,
                           shadow_occluder *out);
void shadow_occluder_free(shadow_occluder *occluder);

/* Computes the visibility of a point light at `light` (camera space) from each pixel: 1 channel in [0, 1], made here,
 * width × height of the same frame. Pixels outside the surface, and those whose normal faces away from the light, may
 * hold any value. */
status shadow_cast(const shadow_occluder *occluder, vec3 light, int width, int height, img *seen);
/* Does the same for a near or distant lamp. */
status shadow_cast_lamp(const shadow_occluder *occluder, const lamp *light, int width, int height, img *seen);

/* Multiplies image (any size of the same frame, any channels) by seen (1 channel, or as many), interpolated. */
void shadow_darken(const img *seen, img *image);

#endif
