/* SPDX-License-Identifier: MIT */
/* Whole files: read into memory, and written so that a reader sees the old file or the new one, never half of it. */
#ifndef MERLIN_BASE_FILE_H
#define MERLIN_BASE_FILE_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/status.h"

/* Opens a file for reading in binary; returns NULL and sets errno as fopen does. Pipes, sockets and devices are not
 * opened for reading: fstat on the result tells what they are, so that the caller can refuse them. */
FILE *file_open(const char *path);
/* Does the same for a descriptor; returns -1 and errno as open does. */
int file_open_descriptor(const char *path);
/* Checks a path before a library opens it by name: MERLIN_BAD_INPUT if it is missing or is not a plain file, as opening
 * a pipe could wait forever. */
status file_check_plain(const char *path);

/* Reads a whole file. *data is malloc'ed and ends in one zero byte, which *size does not count. Refuses files over
 * limit bytes. */
status file_read(const char *path, size_t limit, char **data, size_t *size);
/* Returns the folder that a path lies in, malloc'ed: "." for a bare name, "/" for what is directly there; NULL without
 * memory. */
char *file_folder_of(const char *path);
/* Returns what follows the last slash, a pointer into the path itself. */
const char *file_name_of(const char *path);
/* Fills in the folder of the running program, without a trailing slash, by which files installed beside it are found.
 * Returns false if the system does not tell. */
bool file_program_folder(char folder[PATH_MAX]);
/* Returns the length of the UTF-8 byte order mark that Windows puts before a text; 0 without one. */
size_t file_text_mark(const char *text, size_t size);

/* Bytes of a file, mapped for reading without a copy; zero-initialized it is empty. The file must not be truncated
 * while it is mapped, which holds for files that are replaced by rename, as this project does. */
typedef struct file_view {
    const void *data;
    size_t size;
} file_view;
/* Maps a file; refuses what file_read refuses. */
status file_map(const char *path, size_t limit, file_view *out);
void file_unmap(file_view *view);

/* Writes a whole file to a temporary name beside it and renames it: after a killed process or a full disk the old file
 * is still there. file_write_durable also waits for the disk, so that the same holds after a power cut: for results of
 * hours of work. */
status file_write(const char *path, const void *data, size_t size);
status file_write_durable(const char *path, const void *data, size_t size);

/* Writes what is too large to be assembled in memory, as file_write does: calls print with the open file. Numbers are
 * printed with a decimal point in every locale. */
typedef void file_printer(FILE *f, const void *context);
status file_print(const char *path, file_printer *print, const void *context);

/* Helps libraries that write by name. file_temporary returns a temporary name beside path with path's own extension, by
 * which the library picks the format (malloc'ed); then file_commit renames it to path and frees the name, or
 * file_discard removes the file and frees the name. Folders, devices and pipes are refused. */
status file_temporary(const char *path, char **temporary);
status file_commit(char *temporary, const char *path);
void file_discard(char *temporary);
/* Ends the writing of several such files: commits all where s is OK, else discards them, puts the paths in the place of
 * the temporary names in the message, and returns s. Entries of aside that are NULL are passed over. */
status file_commit_all(status s, char *const *aside, const char *const *paths, size_t count);

/* Checks that a file can be written there, by creating one beside it: called before long work whose result goes there.
 */
status file_check_writable(const char *path);

bool file_exists(const char *path);
bool file_is_folder(const char *path);
/* Tells whether a folder holds a file or folder of this name. */
bool file_is_in(const char *folder, const char *name);
/* Tells whether two paths lead to the same existing file or folder. */
bool file_is_same(const char *one, const char *other);
/* Makes a folder and its missing parents. */
status file_make_folder(const char *path);
/* Returns "folder/name", malloc'ed. */
char *file_join(const char *folder, const char *name);
/* Returns the name in the folder for temporary files, $TMPDIR or /tmp; malloc'ed. */
char *file_in_scratch(const char *name);
/* Tells whether a name has this extension (".png", in any case) after at least one character; file_ends_in_any: any of
 * a NULL-terminated list. */
bool file_ends_in(const char *name, const char *ending);
bool file_ends_in_any(const char *name, const char *const *endings);

/* Compares as strcmp does, but orders numbers by value: 9.png before 10.png, 2.png and 02.png before 3.png. */
int file_compare_names(const char *a, const char *b);

/* Lists the plain files of a folder whose names have one of the extensions (file_ends_in_any; NULL means all), each
 * joined to the folder and sorted by file_compare_names. *names and its entries are malloc'ed. */
status file_list(const char *folder, const char *const *endings, char ***names, size_t *count);
/* Finds the folder's first file with one of these names, which end with NULL, in any case; *path is NULL if there is
 * none. Free it. */
status file_find_named(const char *folder, const char *const *usual, char **path);
/* Lists the files of a folder and of all folders below it, as file_list does. */
status file_list_deep(const char *folder, const char *const *endings, char ***names, size_t *count);
void file_list_free(char **names, size_t count);

#endif
