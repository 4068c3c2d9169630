/* SPDX-License-Identifier: MIT */
/* Names of what is being written, and the removal of such things where their process has ended without it.
 *
 * A name carries a mark of the machine, its start and the space of its process numbers, and the number of a process or
 * thread: what bears the own mark and a number that no one has is nobody's. What bears another mark may be a living
 * process's, elsewhere on a network, and is left until nothing has touched it for a day.
 *
 *     .0123abcd-4711~albedo.png           a file            (leftovers_file_name)
 *     .merlin-0123abcd-4711-XXXXXX        a folder of files, for mkdtemp
 *
 * A program that dies of a signal can remove its own on the way (leftovers_remove_own). */
#ifndef MERLIN_BASE_LEFTOVERS_H
#define MERLIN_BASE_LEFTOVERS_H

#include <stddef.h>

enum { LEFTOVERS_NAME = 64, LEFTOVERS_FRONT = 24 };

/* Writes what stands before a file's own name, at most LEFTOVERS_FRONT letters. */
void leftovers_file_front(char front[LEFTOVERS_FRONT]);
/* Writes the template of a folder's name. */
void leftovers_folder_name(char name[LEFTOVERS_NAME]);

/* Removes what dead processes have left in a folder; nothing that fails is of any consequence. */
void leftovers_clear(const char *folder);
/* The same, unless the folder is that of the last such call: for each of many files. */
void leftovers_clear_once(const char *folder);

/* Notes a path, which must stay until leftovers_forget. Of a folder its plain files go with it, and those folders above
 * it whose paths are longer than `kept`; kept 0: it is a file. Any thread. */
void leftovers_note(const char *path, size_t kept);
void leftovers_forget(const char *path);
/* Removes all that is noted; may be called by a signal's handler. */
void leftovers_remove_own(void);

#endif
