/* SPDX-License-Identifier: MIT */
/* Poses an object before the camera: rotated, scaled by its silhouette, kept in frame. */
#ifndef MERLIN_LAB_SCENE_OBJECT_POSE_H
#define MERLIN_LAB_SCENE_OBJECT_POSE_H

#include "lab/scene/shape/shape.h"

/* Moves a normalized mesh's positions (and normals, if it has them) into camera space near (0, 0, -1), so that its
 * silhouette covers 25 to 75 % of the square frame of a camera with this field of view (degrees). Except for one object
 * in twenty it is inside the frame, and always at depth 0.4 or more. Thin objects are stretched a little if no size
 * fits. */
void pose_object(rng *r, triangle_mesh *mesh, const shape_traits *traits, float fov);

#endif
