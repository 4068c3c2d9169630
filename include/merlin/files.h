/* SPDX-License-Identifier: MIT */
/* merlin/files: what was written, and what was left aside of a folder that was read. */
#ifndef MERLIN_FILES_H
#define MERLIN_FILES_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The paths of files that were written, sorted. Zero-initialized it is empty. */
typedef struct merlin_files {
    char **at;
    size_t count;
    uint64_t bytes; /* the sum of their sizes */
} merlin_files;
void merlin_files_free(merlin_files *files);

typedef struct merlin_skipped_file {
    char *name; /* in its folder */
    char *why;  /* the reason, without a full stop */
} merlin_skipped_file;

/* Files of a folder that were left aside; freed with what it is part of. */
typedef struct merlin_skipped_files {
    merlin_skipped_file *at;
    size_t count;
} merlin_skipped_files;

#ifdef __cplusplus
}
#endif

#endif
