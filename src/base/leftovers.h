/* SPDX-License-Identifier: MIT */
/* Names of temporary files, and the removal of those that dead processes have left.
 *
 * A name carries a mark of the machine, its boot and its namespace of process numbers, and the number of a process or
 * thread. A file with this machine's mark and the number of no living process is stale. A file with another mark may
 * belong to a living process elsewhere on a network, and counts as stale once nothing has touched it for a day.
 *
 *     .0123abcd-4711~albedo.png           a file            (leftovers_file_front)
 *     .merlin-0123abcd-4711-XXXXXX        a folder of files, for mkdtemp
 *
 * A program that dies of a signal can remove its own files first (leftovers_remove_own). */
#ifndef MERLIN_BASE_LEFTOVERS_H
#define MERLIN_BASE_LEFTOVERS_H

#include <stddef.h>

enum { LEFTOVERS_NAME = 64, LEFTOVERS_FRONT = 24 };

/* Writes the prefix of a temporary file's name, less than LEFTOVERS_FRONT characters. */
void leftovers_file_front(char front[LEFTOVERS_FRONT]);
/* Writes the template of a temporary folder's name, for mkdtemp. */
void leftovers_folder_name(char name[LEFTOVERS_NAME]);

/* Removes a folder and the plain files in it. No memory is asked for. */
void leftovers_remove_folder(const char *path);
/* Removes stale temporary files from a folder; failures are ignored. */
void leftovers_clear(const char *folder);
/* Calls leftovers_clear unless the last call was for the same folder: cheap for many files in turn. */
void leftovers_clear_once(const char *folder);

/* Records a path to be removed by leftovers_remove_own until leftovers_forget; the string must stay valid until then.
 * kept 0: a file. Otherwise a folder, removed with its plain files and with those parents whose paths are longer than
 * `kept`. May be called from any thread. */
void leftovers_note(const char *path, size_t kept);
void leftovers_forget(const char *path);
/* Removes everything recorded; safe in a signal handler. */
void leftovers_remove_own(void);

#endif
