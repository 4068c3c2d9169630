/* SPDX-License-Identifier: MIT */
/* The shadow that a visible surface casts on itself.
 *
 *     shadow_occluder occluder;
 *     status s = shadow_occluder_new(&depth, &normal, &mask, 60, &occluder);    once a surface
 *     img seen;
 *     s = shadow_cast(&occluder, light, side, &seen);                         once a light
 *     shadow_darken(&seen, &direct);
 *     shadow_occluder_free(&occluder);
 *
 * From every pixel a ray is followed toward the light through the depth map, a pixel a step. It is stopped where it
 * runs behind the map, by more than the map's own error and less than the object's thickness. Of the thickness nothing
 * is known but what objects are like; behind something thinner a ray passes to the light. Borders are soft: the further
 * the way, the less sure is an estimated depth of where the shadow ends.
 *
 * Depth and normals are fused first (fuse.h): shadows are made by slopes, and where the depth alone is followed,
 * its bumps throw shadows that are in no photograph. */
#ifndef MERLIN_ESTIMATE_LIGHT_SHADOW_H
#define MERLIN_ESTIMATE_LIGHT_SHADOW_H

#include "base/vec.h"
#include "image/image.h"
#include "optics/camera.h"
#include "optics/light.h"

/* Of what is seen, in scene units, of which an object is about one wide. Found by trying on samples with path-traced
 * shadows (docs/notes/cast_shadows.md). */
#define SHADOW_THICKNESS 0.15f

typedef struct shadow_occluder {
    img depth; /* 1 channel, fused; continued outside the mask */
    img mask;  /* 1 channel */
    camera_lens lens;
    float nearest, farthest; /* depths inside the mask */
} shadow_occluder;

/* depth 1 channel, normal 3, mask 1, all of one size; 0.5 and more of the mask is surface. Everything is copied. */
status shadow_occluder_new(const img *depth, const img *normal, const img *mask, camera_lens lens,
                           shadow_occluder *out);
void shadow_occluder_free(shadow_occluder *occluder);

/* How much of a point light at `light` (camera space) each pixel sees: 1 channel in [0, 1], made here, width × height
 * of the same frame. Pixels off the surface, and those whose normal turns away from the light, may hold anything there.
 */
status shadow_cast(const shadow_occluder *occluder, vec3 light, int width, int height, img *seen);
/* The same of a lamp, near or distant. */
status shadow_cast_lamp(const shadow_occluder *occluder, const lamp *light, int width, int height, img *seen);

/* image (any size of the same frame, any channels) times seen (1 channel, or as many), interpolated. */
void shadow_darken(const img *seen, img *image);

#endif
