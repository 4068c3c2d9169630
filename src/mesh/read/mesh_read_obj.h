/* SPDX-License-Identifier: MIT */
/* Reads OBJ files (Wavefront's format of 1995, as in common use): v, vn, f and usemtl. Material libraries are not
 * opened, as they do not affect the shape. */
#ifndef MERLIN_MESH_READ_MESH_READ_OBJ_H
#define MERLIN_MESH_READ_MESH_READ_OBJ_H

#include <stddef.h>

#include "mesh/mesh.h"

/* Reads polygons, cut into triangles, into an empty mesh: a part for each material that a face has, 32 at most; normals
 * if every corner has one. MERLIN_BAD_INPUT, naming the line, if the file is damaged or has more than `most` triangles.
 */
status mesh_read_obj(const char *path, size_t most, triangle_mesh *mesh, int *parts);
/* Reads from a text that ends in a zero byte. */
status mesh_parse_obj(const char *text, size_t size, size_t most, triangle_mesh *mesh, int *parts);

#endif
