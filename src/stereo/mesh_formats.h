/* SPDX-License-Identifier: MIT */
/* A built mesh as a file: one source a format. Internal to mesh_write.h. */
#ifndef MERLIN_STEREO_MESH_FORMATS_H
#define MERLIN_STEREO_MESH_FORMATS_H

#include "stereo/mesh_build.h"

status mesh_write_ply(const char *path, const surface_mesh *m, const pst_mesh_source *from);
status mesh_write_obj(const char *path, const surface_mesh *m, const pst_mesh_source *from);
status mesh_write_glb(const char *path, const surface_mesh *m, const pst_mesh_source *from);

#endif
