/* SPDX-License-Identifier: MIT */
/* Where an object stands before the camera: turned, sized by its silhouette, kept in frame. */
#ifndef MERLIN_LAB_SCENE_OBJECT_POSE_H
#define MERLIN_LAB_SCENE_OBJECT_POSE_H

#include "lab/scene/shape/shape.h"

/* Moves a normalized mesh's positions (and normals, if it has them) into camera space near (0, 0, -1), so that its
 * silhouette covers 25 to 75 % of the square frame of a camera with this field of view (degrees), within the frame but
 * for one object in twenty, all of it at depth 0.4 or more. Thin things are stretched a little where no size would do.
 */
void pose_object(rng *r, triangle_mesh *mesh, const shape_traits *traits, float fov);

#endif
