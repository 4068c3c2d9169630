/* SPDX-License-Identifier: MIT */
/* Files as one ZIP archive, stored as they are: pictures and EXR are compressed already. */
#ifndef MERLIN_SERVE_JOBS_ARCHIVE_H
#define MERLIN_SERVE_JOBS_ARCHIVE_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

typedef struct archive_file {
    const char *name; /* name in the archive */
    int descriptor;   /* descriptor, read from its beginning */
    uint64_t bytes;
} archive_file;

/* Writes the archive to a descriptor, from its beginning, and sets *bytes to its size. Archives beyond 4 GB are
 * refused. */
status archive_write(int out, const archive_file *files, size_t count, uint64_t *bytes);

#endif
