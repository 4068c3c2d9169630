/* SPDX-License-Identifier: MIT */
/* A surface as a mesh that opens in Blender and a browser: PLY (vertex colours), OBJ with texture coordinates and MTL,
 * GLB with albedo, normal and roughness maps. The file's ending decides. */
#ifndef MERLIN_MESH_WRITE_MESH_WRITE_H
#define MERLIN_MESH_WRITE_MESH_WRITE_H

#include "mesh/write/mesh_source.h"

/* MERLIN_WRONG_USE unless the name ends in .ply, .obj or .glb. */
status mesh_check_name(const char *path);

/* One vertex a pixel inside the mask; triangles that would bridge a depth jump are left out. Camera space: in
 * depth's unit, or in pixels without perspective, which a GLB's scene scales to a picture one unit large. Albedo is
 * linear in [0, 1]. An OBJ brings NAME.mtl and, with albedo, NAME.png along. */
status mesh_write(const char *path, const mesh_source *from);

#endif
