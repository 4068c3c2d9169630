/* SPDX-License-Identifier: MIT */
/* The normals of a mesh as a tangent-space normal map over the normals of its triangles, so that a decimated mesh keeps
 * its shading. Tangents run along the picture's rows, x to the right and y up. */
#ifndef MERLIN_MESH_WRITE_MESH_NORMAL_MAP_H
#define MERLIN_MESH_WRITE_MESH_NORMAL_MAP_H

#include "base/vec.h"
#include "image/image.h"
#include "merlin/mesh.h"

/* Returns the normals to which the normal map is relative, or the only ones. */
static inline float *mesh_base_normals(const merlin_mesh *m)
{
    return m->face_normals ? m->face_normals : m->normals;
}

/* Returns the direction to the right, made perpendicular to the normal. */
vec3 mesh_tangent_of(vec3 normal);

/* Makes the map: (n + 1) / 2 of 3 channels, of the size of the maps that the mesh was made of; for a mesh that has
 * face_normals. */
status mesh_normal_map(const merlin_mesh *m, img *out);

#endif
