/* SPDX-License-Identifier: MIT */
/* The server's private folder, in which uploads and results lie: a folder for each job, with one for what came in and
 * one for what goes out.
 *
 *     store *s;
 *     char id[STORE_ID], path[PATH_MAX];
 *     if (store_open(&s) == OK && store_add(s, id) == OK) store_path(s, id, STORE_IN, "cup.jpg", path);
 *     ...
 *     store_close(s);                                     removes everything
 *
 * It is named merlin-serve-XXXXXX in $TMPDIR (or /tmp) and open to its owner alone. A file in it is locked as long as
 * the server lives, so that the next start recognizes the folder of one that was killed, and removes it. */
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

/* Removes what killed servers have left, and makes a folder of its own. */
status store_open(store **out);
void store_close(store *s);

/* Makes a job's folders under a new identifier. */
status store_add(const store *s, char id[STORE_ID]);
/* Removes them with all that is in them. */
void store_remove(const store *s, const char *id);
/* Removes the files of one of them, and leaves it. */
void store_empty(const store *s, const char *id, store_part part);

/* Composes the path of a file in a job's folder, or of the folder if name is NULL; returns it. Both are the program's
 * own words or have passed store_safe_name (store/safe_name.h). */
const char *store_path(const store *s, const char *id, store_part part, const char *name, char path[PATH_MAX]);

/* Tells whether a text has the form of an identifier. */
bool store_is_id(const char *text);

#endif
