/* Meshes from OBJ and glTF files, by assimp, and from PLY files. */
#ifndef MERLIN_SCENE_MESH_FILE_H
#define MERLIN_SCENE_MESH_FILE_H

#include "scene/mesh.h"

/* Reads all triangles of the file's scene, its node transforms applied, into an empty mesh; the file's normals are kept
 * when all of it has them. Surfaces that wind inward are turned. *parts becomes the number of meshes in the file, at
 * most 32. ERROR_INPUT when the file is missing, of another kind, damaged, empty or over five million triangles. */
status mesh_read(const char *path, scn_mesh *mesh, int *parts);

#endif
