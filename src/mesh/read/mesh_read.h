/* SPDX-License-Identifier: MIT */
/* Reads meshes from OBJ, PLY and glTF files. */
#ifndef MERLIN_MESH_READ_MESH_READ_H
#define MERLIN_MESH_READ_MESH_READ_H

#include "mesh/mesh.h"

/* Reads all triangles of the file's scene, with node transforms applied, into an empty mesh; the file's normals are
 * kept if all vertices have them. Surfaces that wind inward are reversed. *parts becomes the number of materials in the
 * file, at most MESH_PARTS. MERLIN_BAD_INPUT if the file is missing, of another kind, damaged, empty or over five
 * million triangles. Only plain files are opened. */
status mesh_read(const char *path, triangle_mesh *mesh, int *parts);

#endif
