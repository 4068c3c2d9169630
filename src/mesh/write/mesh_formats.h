/* SPDX-License-Identifier: MIT */
/* Writers of a mesh, one for each format, behind merlin_mesh_write, which has checked it. */
#ifndef MERLIN_MESH_WRITE_MESH_FORMATS_H
#define MERLIN_MESH_WRITE_MESH_FORMATS_H

#include "base/status.h"
#include "merlin/mesh.h"

status mesh_write_ply(const char *path, const merlin_mesh *m);
status mesh_write_obj(const char *path, const merlin_mesh *m);
status mesh_write_glb(const char *path, const merlin_mesh *m);
status mesh_write_usda(const char *path, const merlin_mesh *m);

#endif
