/* SPDX-License-Identifier: MIT */
/* The files that maps are written to and read from. */
#ifndef MERLIN_ESTIMATE_FILES_MAPS_FILES_H
#define MERLIN_ESTIMATE_FILES_MAPS_FILES_H

#include "base/staging.h"
#include "base/watch.h"
#include "image/exr/exr.h"
#include "merlin/merlin.h"

/* Where merlin_maps_write writes, and what only the command line asks of it; each but folder may be NULL. */
typedef struct maps_output {
    const char *folder;
    const char *const *inputs; /* as in staging_begin */
    int (*stop)(void);         /* asked between files */
    const watch *watch;        /* told "writing" */
    bool last;                 /* no photograph follows: the network is released before the files are written */
    /* writes other files beside the maps, or elsewhere, and adds where */
    status (*more)(const void *context, const merlin_maps *maps, maps_staging *to);
    const void *context;
    staged_files *written;
} maps_output;
status maps_write(merlin_model *model, const merlin_maps *maps, const maps_output *to);
/* report.json's text, malloc'ed; NULL if memory ran out. */
char *maps_report(const merlin_maps *maps);
status maps_write_exr(const merlin_maps *maps, const char *path);
/* Makes the attribute of maps.exr that tells, after an editor has had it, whether it still is of the size it was. */
exr_attribute maps_picture_size(int width, int height);
/* All maps of the file's size and what it holds of them; roughness and photo, unless photographed, are not looked for
 * and stay zero. MERLIN_BAD_INPUT for maps that nothing can be made of (maps_examine.h); path is for messages. After a
 * failure, too, merlin_maps_free. */
status maps_read_layers(exr_file *f, const char *path, bool photographed, merlin_maps *maps);
/* Maps as the inside promises them: half floats are not quite unit normals, and anybody may have edited the file. */
void maps_tidy(merlin_maps *maps);

#endif
