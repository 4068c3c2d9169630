/* SPDX-License-Identifier: MIT */
/* Maps among a job's results. */
#ifndef MERLIN_SERVE_JOBS_MAPS_FILES_H
#define MERLIN_SERVE_JOBS_MAPS_FILES_H

#include "serve/jobs/work.h"

/* Files that are written beside those of merlin estimate. */
typedef struct maps_files {
    const char *page; /* the object's name on viewer.html; NULL: no page */
    int mesh;         /* 1: mesh.glb and mesh.ply */
} maps_files;

status maps_files_write(const work_context *w, const merlin_maps *maps, maps_files which);

#endif
