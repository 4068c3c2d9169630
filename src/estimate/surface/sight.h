/* SPDX-License-Identifier: MIT */
/* The camera and light of a photograph, as far as they are known, and their consequences for the maps of its crop.
 *
 *     sight how = sight_of(fov, focal_35mm, width, height, crop);
 *     network_estimate(n, &photo, &mask, &how, views, stop, &estimation);
 *
 * The maps' space is that of a camera that looks at the crop's middle (docs/conventions.md). */
#ifndef MERLIN_ESTIMATE_SURFACE_SIGHT_H
#define MERLIN_ESTIMATE_SURFACE_SIGHT_H

#include "estimate/surface/crop.h"
#include "optics/camera.h"

typedef struct sight {
    camera_lens lens; /* lens of the crop; fov 0: unknown */
    bool flash;       /* whether the only light was a flash at the lens */
} sight;

/* Returns the lens of a crop from a photograph of width × height pixels whose optical axis runs through its middle: by
 * the field of view (fov, degrees), else by the focal length in mm that gives the same on 36 × 24 mm; either may be 0.
 * Impossible values count as unknown. */
sight sight_of(float fov, float focal_35mm, int width, int height, crop_square crop);

/* Rotates normals for the lens's field of view. A model trained on CAMERA_FOV assumes that every pixel is seen along
 * that lens's line of sight; a flash's light comes along the actual one, and shows the angle between it and the
 * surface, so that normals are rotated from the former to the latter. normal: 3 channels; mask: pixels above 0. */
void sight_turn_normals(camera_lens lens, const img *mask, img *normal);

/* Converts depth as relief (nn_render, nn/nn.h) to distances, where mask is above 0. */
void sight_take_relief(camera_lens lens, const img *mask, img *depth);

#endif
