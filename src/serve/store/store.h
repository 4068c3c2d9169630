/* SPDX-License-Identifier: MIT */
/* The server's private folder for uploads and results: a folder for each job, with one for its input and one for its
 * output.
 *
 *     store *s;
 *     char id[STORE_ID], path[PATH_MAX];
 *     if (store_open(&s) == OK && store_add(s, id) == OK) store_path(s, id, STORE_IN, "cup.jpg", path);
 *     ...
 *     store_close(s);                                     removes everything
 *
 * It is named merlin-serve-XXXXXX in $TMPDIR (or /tmp) and accessible only to its owner. A file in it is locked as long
 * as the server runs, so that the next start recognizes the folder of a killed server, and removes it. */
#ifndef MERLIN_SERVE_STORE_STORE_H
#define MERLIN_SERVE_STORE_STORE_H

#include <limits.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/status.h"

typedef struct store store;

/* An identifier: 128 random bits as 32 hexadecimal digits, and a zero. */
enum { STORE_ID = 33 };
typedef enum store_part { STORE_IN, STORE_OUT } store_part;

/* Removes the folders of killed servers, and makes one. */
status store_open(store **out);
void store_close(store *s);

/* Makes a job's folders under a new identifier. */
status store_add(const store *s, char id[STORE_ID]);
/* Removes them with their content. */
void store_remove(const store *s, const char *id);
/* Removes the files of one of them, but not the folder. */
void store_empty(const store *s, const char *id, store_part part);

/* Opens a file for writing and reading that has no name, and is gone when it is closed. */
status store_open_unnamed(const store *s, int *descriptor);

/* Composes the path of a file in a job's folder, or of the folder if name is NULL; returns it. Both names are the
 * program's own or come from safe_name (store/safe_name.h). */
const char *store_path(const store *s, const char *id, store_part part, const char *name, char path[PATH_MAX]);

/* Tells whether a text has the form of an identifier. */
bool store_is_id(const char *text);

#endif
