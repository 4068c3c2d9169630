/* SPDX-License-Identifier: MIT */
/* Pictures whose names differ by a number alone: frame_0001.png, frame_0002.png and so on. */
#ifndef MERLIN_IMAGE_FRAMES_NUMBERED_H
#define MERLIN_IMAGE_FRAMES_NUMBERED_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

typedef struct numbered_file {
    long number;
    char *path;
    char *mask; /* its mask's path, or NULL */
} numbered_file;

typedef struct numbered_files {
    numbered_file *at; /* sorted by number */
    size_t count;
} numbered_files;

/* Tells whether a name is a pattern: one place for the number, as %d, %04d or ####, in its last part. */
bool numbered_is_pattern(const char *path);

/* Find the pictures of a pattern; of a folder, whose masks (NULL, or a folder) may lie in it; or these.
 * MERLIN_BAD_INPUT if there are none, if one has no number or two have the same, or if their names differ otherwise. */
status numbered_of_pattern(const char *pattern, numbered_files *out);
status numbered_of_folder(const char *folder, const char *masks, numbered_files *out);
status numbered_of_paths(const char *const *paths, size_t count, numbered_files *out);
/* Finds all numbered pictures of a folder, whatever else their names are; numbers may repeat. */
status numbered_of_masks(const char *folder, numbered_files *out);
void numbered_free(numbered_files *files);

/* Returns the file with this number, or NULL. */
numbered_file *numbered_find(const numbered_files *files, long number);

#endif
