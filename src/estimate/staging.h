/* A folder's files made aside and moved into place together: a full disk or an interrupt leaves nothing half done.
 *
 *     staging *t;
 *     status s = staging_begin("cup.merlin", &t);
 *     char *path = staging_path(t, "albedo.png");  write it there
 *     s = s == OK ? staging_commit(t) : staging_abort(t, s);
 */
#ifndef MERLIN_ESTIMATE_STAGING_H
#define MERLIN_ESTIMATE_STAGING_H

#include "base/status.h"

typedef struct staging staging;

/* Makes the folder if need be, and a hidden one inside it. */
status staging_begin(const char *folder, staging **out);
/* Where to write the file that will be folder/name: malloc'ed; NULL if memory ran out. Any thread. */
char *staging_path(const staging *t, const char *name);
/* Moves all files into the folder, replacing those of the same names, and frees t. ERROR_OUTPUT, with nothing moved, if
 * a folder is in the way of one. */
status staging_commit(staging *t);
/* Removes what was written, and the folders that staging_begin made; frees t. Returns s, its message naming the folder
 * instead of the hidden one. */
status staging_abort(staging *t, status s);

#endif
