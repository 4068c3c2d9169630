/* SPDX-License-Identifier: MIT */
/* Photographs to process, each with its mask and the place of its results. */
#ifndef MERLIN_COMMAND_PHOTO_LIST_H
#define MERLIN_COMMAND_PHOTO_LIST_H

#include <stddef.h>

#include "base/skipped.h"
#include "merlin/merlin.h"

typedef struct photo_job {
    char *photo, *output;
    char *mask;              /* NULL: alpha, or the object is searched for */
    const merlin_hint *hint; /* hint for the search, or NULL; borrowed */
} photo_job;

typedef struct photo_folder {
    char *path;
    skipped_files skipped;
} photo_folder;

typedef struct photo_list {
    photo_job *at;
    size_t count;
    photo_folder *folder;
    size_t folders;
} photo_list;

#endif
