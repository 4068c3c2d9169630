/* SPDX-License-Identifier: MIT */
/* Writes a surface as a mesh for Blender and browsers: PLY (vertex colours), OBJ with texture coordinates and MTL, or
 * GLB with albedo, normal and roughness maps, by the file's extension. */
#ifndef MERLIN_MESH_WRITE_MESH_WRITE_H
#define MERLIN_MESH_WRITE_MESH_WRITE_H

#include "mesh/write/mesh_source.h"

/* Returns MERLIN_WRONG_USE unless the name ends in .ply, .obj or .glb. */
status mesh_check_name(const char *path);

/* Writes a vertex for each pixel inside the mask; triangles across a depth discontinuity are left out. Positions are in
 * camera space: in depth's unit, or in pixels without perspective, which a GLB's scene scales to a picture one unit
 * large. Albedo is linear in [0, 1]. An OBJ comes with NAME.mtl and, with albedo, NAME.png. */
status mesh_write(const char *path, const mesh_source *from);

#endif
