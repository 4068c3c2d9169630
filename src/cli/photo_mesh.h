/* SPDX-License-Identifier: MIT */
/* What a photograph shows of its object, as a mesh.
 *
 *     status s = photo_mesh_write(&maps, "cup.merlin/mesh.glb"); */
#ifndef MERLIN_CLI_PHOTO_MESH_H
#define MERLIN_CLI_PHOTO_MESH_H

#include "base/status.h"
#include "merlin/merlin.h"

/* path ends in .glb, .obj or .ply. The front alone: a photograph knows nothing of the back. Camera space, the object
 * about (0, 0, -1). */
status photo_mesh_write(const merlin_maps *maps, const char *path);

#endif
