/* SPDX-License-Identifier: MIT */
/* Other shapes out of one: mirrored, stretched, bent, twisted, tapered, dented, or, a third of them, as they are. */
#ifndef MERLIN_LAB_SCENE_SHAPE_MESH_DEFORM_H
#define MERLIN_LAB_SCENE_SHAPE_MESH_DEFORM_H

#include "base/rng.h"
#include "mesh/mesh.h"

/* Positions alone: the material keeps to the shape that was (references). The file's normals are dropped. */
void mesh_deform(rng *r, triangle_mesh *mesh);

#endif
