/* SPDX-License-Identifier: MIT */
/* Files as wholes: read into memory, and written so that a reader sees the old file or the new one, never half. */
#ifndef MERLIN_BASE_FILE_H
#define MERLIN_BASE_FILE_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/status.h"

/* Opens a file for reading in binary; NULL and errno as fopen's. Pipes, sockets and devices are not opened: what comes
 * of them can be told by fstat, to be refused, and not be read. */
FILE *file_open(const char *path);
/* For libraries that open by name: MERLIN_BAD_INPUT for what is missing or is no plain file, which opening could wait
 * for.
 */
status file_check_plain(const char *path);

/* Reads all of a file; *data is malloc'ed, one zero byte is put behind it, *size excludes that byte. Refuses files over
 * limit bytes. */
status file_read(const char *path, size_t limit, char **data, size_t *size);
/* The folder that a path lies in, malloc'ed: "." of a name alone, "/" of what is there; NULL without memory. */
char *file_folder_of(const char *path);
/* What stands behind the last slash, in the path itself. */
const char *file_name_of(const char *path);
/* Fills in the folder that the running program lies in, without a slash behind it (what lies beside it is found by
 * that); false where the system does not tell. */
bool file_program_folder(char folder[PATH_MAX]);
/* Bytes of the mark of UTF-8 that Windows puts before a text; 0 without one. */
size_t file_text_mark(const char *text, size_t size);

/* A file's bytes without a copy, for reading; zero-initialized is none. The file must not shrink while it is mapped:
 * for files that are replaced as wholes, as all that this project writes are. */
typedef struct file_view {
    const void *data;
    size_t size;
} file_view;
/* The same refusals as file_read. */
status file_map(const char *path, size_t limit, file_view *out);
void file_unmap(file_view *view);

/* Writes all of a file through a temporary name beside it and rename: a killed process or a full disk leaves the old
 * file. file_write_durable also waits for the disk, so that a power cut does too: for what took hours to make. */
status file_write(const char *path, const void *data, size_t size);
status file_write_durable(const char *path, const void *data, size_t size);

/* The same for what is too large to be put together in memory first: print is given the open file, and prints numbers
 * with a decimal point in every locale. */
typedef void file_printer(FILE *f, const void *context);
status file_print(const char *path, file_printer *print, const void *context);

/* For libraries that write by name: a temporary name beside path, with path's own ending so that the library picks the
 * right format (malloc'ed); then file_commit renames it to path and frees the name, or file_discard removes and frees
 * it. Folders, devices and pipes are refused. */
status file_temporary(const char *path, char **temporary);
status file_commit(char *temporary, const char *path);
void file_discard(char *temporary);

/* Whether a file could be written there, by making one beside it: for what is to be written after long work. */
status file_check_writable(const char *path);

bool file_exists(const char *path);
bool file_is_folder(const char *path);
/* Whether a folder holds a file or folder of this name. */
bool file_is_in(const char *folder, const char *name);
/* Whether two paths lead to one file or folder, which exists. */
bool file_is_same(const char *one, const char *other);
/* Makes a folder and those above it. */
status file_make_folder(const char *path);
/* "folder/name", malloc'ed. */
char *file_join(const char *folder, const char *name);
/* The name in the folder for passing files, $TMPDIR, else /tmp; malloc'ed. */
char *file_in_scratch(const char *name);
/* Whether a name ends so (".png", in any case) behind at least one letter; any: in one of a list up to NULL. */
bool file_ends_in(const char *name, const char *ending);
bool file_ends_in_any(const char *name, const char *const *endings);

/* Compares as strcmp does, but numbers as people count: 9.png before 10.png, 2.png and 02.png before 3.png. */
int file_compare_names(const char *a, const char *b);

/* The plain files of a folder whose names end in one of the endings (file_ends_in_any), sorted by name with numbers as
 * people count, 9.png before 10.png, each joined to the folder; *names and its entries are malloc'ed. endings NULL
 * means all. */
status file_list(const char *folder, const char *const *endings, char ***names, size_t *count);
/* The same with the files of the folders in it. */
status file_list_deep(const char *folder, const char *const *endings, char ***names, size_t *count);
void file_list_free(char **names, size_t count);

#endif
