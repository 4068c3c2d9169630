/* SPDX-License-Identifier: MIT */
/* merlin/files: files that were written, and files of a folder that were skipped. */
#ifndef MERLIN_FILES_H
#define MERLIN_FILES_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Paths of files that were written, sorted. Zero-initialized it is empty. */
typedef struct merlin_files {
    char **at;
    size_t count;
    uint64_t bytes; /* sum of their sizes */
} merlin_files;
void merlin_files_free(merlin_files *files);

typedef struct merlin_skipped_file {
    char *name; /* name in its folder */
    char *why;  /* reason, without a full stop */
} merlin_skipped_file;

/* Files of a folder that were skipped; freed with the struct that contains them. */
typedef struct merlin_skipped_files {
    merlin_skipped_file *at;
    size_t count;
} merlin_skipped_files;

#ifdef __cplusplus
}
#endif

#endif
