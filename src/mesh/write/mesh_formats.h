/* SPDX-License-Identifier: MIT */
/* Writers of a surface mesh, one for each format. Internal to mesh_write.h. */
#ifndef MERLIN_MESH_WRITE_MESH_FORMATS_H
#define MERLIN_MESH_WRITE_MESH_FORMATS_H

#include "mesh/write/surface_mesh.h"

status mesh_write_ply(const char *path, const surface_mesh *m, const mesh_source *from);
status mesh_write_obj(const char *path, const surface_mesh *m, const mesh_source *from);
status mesh_write_glb(const char *path, const surface_mesh *m, const mesh_source *from);

#endif
