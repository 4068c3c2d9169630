/* SPDX-License-Identifier: MIT */
/* The output files of one folder, written by several threads at once: all of them or, after a failure, none.
 *
 *     static status write_mask(const void *job, const char *path);
 *     static const folder_file files[] = {{"mask.png", write_mask}, ...};
 *     const folder_batch batch = {files, sizeof files / sizeof *files, &job, "cup.merlin", .steps = 2};
 *     status s = folder_batch_write(&batch);
 */
#ifndef MERLIN_BASE_FOLDER_BATCH_H
#define MERLIN_BASE_FOLDER_BATCH_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "base/watch.h"

typedef struct folder_file {
    const char *name;
    status (*write)(const void *job, const char *path); /* called from any thread */
} folder_file;

typedef struct folder_batch {
    const folder_file *files; /* table of the files, the slowest first, so that two processors finish together */
    size_t count;
    const void *job; /* passed to each write */
    const char *folder;
    bool in_place; /* whether to write into the folder itself, which exists, instead of aside */
    watch watch;   /* receives "writing" in the calling thread */
    size_t steps;  /* number of steps to which the watch's share refers: the files and what the caller adds */
} folder_batch;

/* Writes the files. MERLIN_STOPPED if the watch stops between two of them. */
status folder_batch_write(const folder_batch *batch);

#endif
