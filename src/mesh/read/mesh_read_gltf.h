/* SPDX-License-Identifier: MIT */
/* glTF and GLB files, version 2: triangles, strips and fans of all meshes of the scene, where its nodes put them, in
 * the pose in which they are stored. */
#ifndef MERLIN_MESH_READ_MESH_READ_GLTF_H
#define MERLIN_MESH_READ_MESH_READ_GLTF_H

#include <stddef.h>

#include "mesh/mesh.h"

/* Into an empty mesh: a part for each material, 32 at most; normals where all of it has them. MERLIN_BAD_INPUT for what
 * is damaged, compressed, or has more triangles than mesh_most_triangles. */
status mesh_read_gltf(const char *path, triangle_mesh *mesh, int *parts);
/* The same from bytes; folder: where its buffers lie, or NULL. */
status mesh_parse_gltf(const void *bytes, size_t size, const char *folder, triangle_mesh *mesh, int *parts);

#endif
