/* SPDX-License-Identifier: MIT */
/* Displacement of a mesh by noise. */
#ifndef MERLIN_LAB_SCENE_SHAPE_MESH_DISPLACE_H
#define MERLIN_LAB_SCENE_SHAPE_MESH_DISPLACE_H

#include "mesh/mesh.h"

/* Moves vertices from `first` on along their smooth normals by amount x smooth solid noise of this frequency. */
void mesh_displace(triangle_mesh *mesh, uint32_t first, float amount, float frequency, int octaves, uint32_t seed);

#endif
