/* SPDX-License-Identifier: MIT */
/* The files of merlin stereo: those of a surface, the page and the meshes. */
#ifndef MERLIN_CLI_STEREO_STEREO_OUTPUT_H
#define MERLIN_CLI_STEREO_STEREO_OUTPUT_H

#include <stdbool.h>

#include "base/staging.h"
#include "cli/mesh_file.h"
#include "merlin/surface.h"

typedef struct stereo_files {
    const char *folder;
    const char *const *inputs; /* as in staging_begin */
    mesh_names mesh;           /* none: mesh.ply, mesh.obj and mesh.glb in the folder */
    bool page;                 /* also write viewer.html */
    const char *input;         /* what the surface is of, for the report */
    int (*stop)(void);
} stereo_files;

/* Writes the surface's folder (merlin_surface_write), the page and the meshes: all of them, with their paths added to
 * *written, or, after a failure, none. Adds what should be known of the page to the surface's warnings. */
status stereo_write(const stereo_files *files, merlin_surface *surface, staged_files *written);

#endif
