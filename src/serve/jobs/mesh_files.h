/* SPDX-License-Identifier: MIT */
/* Meshes among a job's results. */
#ifndef MERLIN_SERVE_JOBS_MESH_FILES_H
#define MERLIN_SERVE_JOBS_MESH_FILES_H

#include "serve/jobs/work.h"

/* Writes mesh.glb and mesh.ply. */
status mesh_files_write(const work_context *w, const merlin_mesh *mesh);

#endif
