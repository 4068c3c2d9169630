/* SPDX-License-Identifier: MIT */
/* Reads glTF and GLB files, version 2: triangles, strips and fans of all meshes of the scene, placed by their nodes, in
 * the stored pose. */
#ifndef MERLIN_MESH_READ_MESH_READ_GLTF_H
#define MERLIN_MESH_READ_MESH_READ_GLTF_H

#include <stddef.h>

#include "mesh/mesh.h"

/* Reads into an empty mesh: a part for each material, 32 at most; normals if all primitives have them. MERLIN_BAD_INPUT
 * if the file is damaged, compressed, or has more triangles than mesh_most_triangles. */
status mesh_read_gltf(const char *path, triangle_mesh *mesh, int *parts);
/* Reads from bytes; folder: where its buffers are, or NULL. */
status mesh_parse_gltf(const void *bytes, size_t size, const char *folder, triangle_mesh *mesh, int *parts);

#endif
