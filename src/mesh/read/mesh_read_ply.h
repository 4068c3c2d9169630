/* SPDX-License-Identifier: MIT */
/* Reads PLY files, ascii and binary little endian (Turk 1994). */
#ifndef MERLIN_MESH_READ_MESH_READ_PLY_H
#define MERLIN_MESH_READ_MESH_READ_PLY_H

#include <stddef.h>

#include "mesh/mesh.h"

/* Reads vertices (with normals, if they have nx, ny, nz) and polygons, cut into fans, into an empty mesh.
 * MERLIN_BAD_INPUT if the file is damaged or not PLY. */
status mesh_read_ply(const char *path, triangle_mesh *mesh);
/* Reads from bytes followed by a zero. */
status mesh_parse_ply(const char *data, size_t size, triangle_mesh *mesh);

#endif
