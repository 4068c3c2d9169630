/* SPDX-License-Identifier: MIT */
/* The request to merlin estimate, and the files of one photograph or frame. */
#ifndef MERLIN_CLI_ESTIMATE_WRITE_H
#define MERLIN_CLI_ESTIMATE_WRITE_H

#include <stdbool.h>

#include "base/staging.h"
#include "base/warnings.h"
#include "base/watch.h"
#include "cli/mesh_file.h"
#include "cli/stage_bar.h"
#include "command/photos.h"

typedef struct estimate_request {
    const char *mask, *output, *model_name;
    char *weights, *flash_weights; /* files; the second is NULL for none */
    merlin_params params;
    photo_share share; /* share of the photographs; with total 0: all */
    bool mesh, html, flash, resume, json, quiet, help;
    bool sequence; /* the photographs are frames of one sequence */
    int smooth;    /* frames of its moving average; 0: each by itself; -1: not given */
    mesh_names meshes;
    merlin_model *model;
    const photo_list *photos;
    bool *told; /* reports skipped files of folders */
    stage_bar *bar;
    const watch *watch; /* progress bar */
} estimate_request;

/* Maps to write: their photograph, the folder, and inputs as in staging_begin. */
typedef struct estimate_write {
    const estimate_request *request;
    const char *photo, *output;
    const char *const *inputs;
    const photo_job *job; /* what the report is to name as its source; NULL: nothing */
} estimate_write;

/* Writes the maps and the other files that were asked for: all or none. last: no photograph follows. */
status estimate_write_files(const estimate_write *w, const merlin_maps *maps, bool last, staged_files *written);

/* Lists what one should know about maps that were written into a folder, with a page or without, and about that folder.
 */
void estimate_find_doubts(bool page, const char *folder, const merlin_maps *maps, const staged_files *written,
                          warnings *doubts);

#endif
