/* SPDX-License-Identifier: MIT */
/* How a photograph was taken, as far as anybody knows, and what follows of it for the maps of its crop.
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
    camera_lens lens; /* of the crop; fov 0: not known */
    bool flash;       /* its light was a flash at the lens and nothing else */
} sight;

/* Of a photograph of width × height pixels, its lens's axis through its middle: by how wide it is (fov, degrees), else
 * by the focal length in mm that gives the same on 36 × 24 mm; either may be 0. What cannot be is not known. */
sight sight_of(float fov, float focal_35mm, int width, int height, crop_square crop);

/* A model that knows a lens of CAMERA_FOV alone takes every pixel to be seen along that lens's line of sight. A
 * flash's light comes along the true one, and what is seen by it is how a surface is turned against it: its normals are
 * turned from the one to the other. normal: 3 channels; mask: where it is above 0. */
void sight_turn_normals(camera_lens lens, const img *mask, img *normal);

/* Depth as relief (nn_render, nn/nn.h) to distances, where mask is above 0. */
void sight_take_relief(camera_lens lens, const img *mask, img *depth);

#endif
