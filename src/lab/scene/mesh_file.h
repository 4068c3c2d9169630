/* Meshes from OBJ, PLY and glTF files. */
#ifndef MERLIN_LAB_SCENE_MESH_FILE_H
#define MERLIN_LAB_SCENE_MESH_FILE_H

#include <stddef.h>

#include "lab/scene/mesh.h"

enum { MESH_BYTES = 1 << 30 }; /* of a file, or of all that make one mesh */

/* Reads all triangles of the file's scene, its node transforms applied, into an empty mesh; the file's normals are kept
 * when all of it has them. Surfaces that wind inward are turned. *parts becomes the number of materials in the file, at
 * most MESH_PARTS. ERROR_INPUT when the file is missing, of another kind, damaged, empty or over five million
 * triangles. Only plain files are opened. */
status mesh_read(const char *path, scn_mesh *mesh, int *parts);

/* Returns how many triangles a mesh of so many bytes may have: five million, and of a small file, which can only repeat
 * itself, one and what it has bytes for. */
size_t mesh_most_triangles(size_t bytes);

#endif
