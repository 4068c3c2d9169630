/* SPDX-License-Identifier: MIT */
/* Files of a folder that were left out, each with the reason, reported to the user in one line.
 *
 *     skipped_files left = {0};
 *     status s = skipped_add(&left, "a.jxl", "JPEG XL is not read");
 *     ...
 *     skipped_warn(&left, &doubts);      "2 files skipped: a.jxl, b.jxl (JPEG XL is not read)"
 *     skipped_json(&left, "photos", json_put_array(report, "skipped"));
 *     skipped_free(&left);
 */
#ifndef MERLIN_BASE_SKIPPED_H
#define MERLIN_BASE_SKIPPED_H

#include <cjson/cJSON.h>
#include <stddef.h>

#include "base/status.h"
#include "base/warnings.h"
#include "merlin/files.h"

/* The library's own list, by short names for the inside. */
typedef merlin_skipped_file skipped_file;
typedef merlin_skipped_files skipped_files;

/* Adds a file; both texts are copied. */
status skipped_add(skipped_files *list, const char *name, const char *why);
/* Moves the entries of `more` to the end of the list. */
status skipped_append(skipped_files *list, skipped_files *more);
/* Writes how many there are and as many names as fit; "" if there are none. */
void skipped_words(const skipped_files *list, char *words, size_t size);
/* Adds the warning files_skipped, if there are any. */
void skipped_warn(const skipped_files *list, warnings *out);
/* Prints "merlin COMMAND: FOLDER: 2 files skipped: ..." as one line to standard error, if there are any. */
void skipped_print(const skipped_files *list, const char *command, const char *folder);
/* Adds objects with file, a path in this folder, and why to an array. */
void skipped_json(const skipped_files *list, const char *folder, cJSON *array);
void skipped_free(skipped_files *list);

#endif
