/* SPDX-License-Identifier: MIT */
/* Random variants of a shape: mirrored, stretched, bent, twisted, tapered, dented or, a third of them, unchanged. */
#ifndef MERLIN_LAB_SCENE_SHAPE_MESH_DEFORM_H
#define MERLIN_LAB_SCENE_SHAPE_MESH_DEFORM_H

#include "base/rng.h"
#include "mesh/mesh.h"

/* Deforms positions only: the material stays with the original shape (references). The file's normals are dropped. */
void mesh_deform(rng *r, triangle_mesh *mesh);

#endif
