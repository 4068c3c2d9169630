/* SPDX-License-Identifier: MIT */
/* A mesh named by --mesh FILE, written together with maps in another place: all or none.
 *
 *     mesh_file m = {.path = "cup.obj", .folder = "cup.merlin", .inputs = inputs, .maps = maps, .mesh = &mesh};
 *     staging *t;
 *     status s = mesh_file_stage(&m, &t);
 *     ... staging_commit_all with the maps, or staging_abort ... */
#ifndef MERLIN_CLI_MESH_FILE_H
#define MERLIN_CLI_MESH_FILE_H

#include <stdbool.h>

#include "base/staging.h"
#include "merlin/mesh.h"

enum { MESH_MOST_FILES = MAPS_MOST_ELSEWHERE };

typedef struct mesh_file {
    const char *path;
    const char *folder;        /* folder of the maps */
    const char *const *inputs; /* as in staging_begin; the first may be a folder of pictures */
    const staging *maps;
    const merlin_mesh *mesh;
} mesh_file;

/* Names given by --mesh. */
typedef struct mesh_names {
    const char *at[MESH_MOST_FILES];
    int count;
} mesh_names;

/* Takes the value of --mesh, for a row of command/options.h; into is a mesh_names. */
status mesh_take_name(const char *path, void *into);
/* Tells whether a word after --mesh is a mesh's name, in a supported format or not. */
bool mesh_is_name(const char *word);

/* Writes a mesh to a temporary place in its folder, as it may consist of several files. *out is NULL only if nothing
 * needs to be aborted. */
status mesh_file_stage(const mesh_file *m, staging **out);

#endif
