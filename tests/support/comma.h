/* SPDX-License-Identifier: MIT */
/* A locale with decimal commas, as in half of Europe.
 *
 *     if (!comma_begin(scratch)) return;     prints that the rest is skipped
 *     ...
 *     comma_end();
 */
#ifndef MERLIN_TESTS_COMMA_H
#define MERLIN_TESTS_COMMA_H

#include <stdbool.h>

/* Sets the program's locale to one that is made in this folder, because a machine may have none. */
bool comma_begin(const char *folder);
void comma_end(void);

#endif
