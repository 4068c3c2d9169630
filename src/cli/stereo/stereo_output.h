/* SPDX-License-Identifier: MIT */
/* The files of merlin stereo: maps, pictures for people, meshes and a report. */
#ifndef MERLIN_CLI_STEREO_STEREO_OUTPUT_H
#define MERLIN_CLI_STEREO_STEREO_OUTPUT_H

#include <cJSON.h>

#include "base/staging.h"
#include "cli/mesh_file.h"
#include "cli/stereo/stereo_result.h"

typedef struct stereo_files {
    const char *folder;
    const char *const *inputs; /* as in staging_begin */
    mesh_names mesh;           /* none: mesh.ply, mesh.obj and mesh.glb in the folder */
    bool page;                 /* whether to write viewer.html */
    const char *input;         /* source of its maps */
    int (*stop)(void);
} stereo_files;

/* Writes maps.exr, normal.png (16 bits), albedo.png, depth.png, mask.png, error.png, overview.png, report.json, the
 * page and the meshes in their places: all, with their paths added to *written, or, after a failure, none. */
status stereo_write(const stereo_files *files, const stereo_result *r, const cJSON *report, staged_files *written);

#endif
