/* PLY files, ascii and binary little endian (Turk 1994). Read here rather than by assimp, whose version in Debian 12
 * reads past the end of a damaged binary file. */
#ifndef MERLIN_SCENE_MESH_PLY_H
#define MERLIN_SCENE_MESH_PLY_H

#include "scene/mesh.h"

/* Reads vertices (with normals, if they have nx, ny, nz) and polygons, cut into fans, into an empty mesh. ERROR_INPUT
 * for what is damaged or not PLY. */
status mesh_read_ply(const char *path, scn_mesh *mesh);

#endif
