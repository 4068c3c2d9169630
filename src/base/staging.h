/* SPDX-License-Identifier: MIT */
/* Writes the files of a folder to a hidden folder first and moves them into place together: a full disk or an interrupt
 * leaves nothing half done.
 *
 *     staging *t;
 *     const char *const inputs[STAGING_MOST_INPUTS] = {"cup.jpg"};
 *     staging_begin("cup.merlin", inputs, &t);
 *     char path[PATH_MAX];
 *     status s = img_write_png(staging_path(t, "albedo.png", path), &albedo, IMG_SRGB8);
 *     s = s == OK ? staging_commit(t, NULL) : staging_abort(t, s);
 */
#ifndef MERLIN_BASE_STAGING_H
#define MERLIN_BASE_STAGING_H

#include <limits.h>
#include <stddef.h>

#include "base/status.h"
#include "merlin/files.h"

typedef struct staging staging;

/* Makes the folder if it is missing, and a hidden one inside it. inputs: STAGING_MOST_INPUTS files that are read for
 * this and that a commit must not replace; each may be NULL, as may the array; the names must outlive t. */
enum { STAGING_MOST_INPUTS = 4 };
status staging_begin(const char *folder, const char *const *inputs, staging **out);
/* Returns the hidden folder, for what writes several files by itself. */
const char *staging_folder(const staging *t);
/* Composes the path at which to write the future folder/name, and returns it. May be called from any thread. */
const char *staging_path(const staging *t, const char *name, char path[PATH_MAX]);
/* Marks a file of the folder, which an earlier run of the same writer made, to be removed at the commit unless it is
 * written again. It may be missing. */
status staging_drop(staging *t, const char *name);
/* Marks BEFORE0AFTER, BEFORE1AFTER and so on, as far as the folder has them without a gap. */
status staging_drop_numbered(staging *t, const char *before, const char *after);
/* The library's own list of what was written, by a short name for the inside. */
typedef merlin_files staged_files;

/* Moves all files into the folder, replacing those of the same names, removes those that were marked, adds their paths
 * to *written unless that is NULL, and frees t. MERLIN_CANNOT_WRITE, with nothing moved, if a folder or one of the
 * inputs is in the way. */
status staging_commit(staging *t, staged_files *written);
/* Commits several folders at once: nothing is moved if anything is in the way in any of them. */
status staging_commit_all(staging *const *t, int count, staged_files *written);
/* Largest number of files beside a folder of maps that are committed with it; the first is the maps'. */
enum { MAPS_MOST_ELSEWHERE = 8 };
typedef struct maps_staging {
    staging *at[1 + MAPS_MOST_ELSEWHERE];
    int count;
} maps_staging;

/* Removes what was written, and the folders that staging_begin made; frees t. Returns s, with the folder in its message
 * instead of the hidden one. */
status staging_abort(staging *t, status s);

#endif
