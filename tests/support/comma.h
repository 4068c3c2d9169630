/* SPDX-License-Identifier: MIT */
/* A locale with decimal commas, as half of Europe has.
 *
 *     if (!comma_begin(scratch)) return;     says so and leaves out what follows
 *     ...
 *     comma_end();
 */
#ifndef MERLIN_TESTS_COMMA_H
#define MERLIN_TESTS_COMMA_H

#include <stdbool.h>

/* The program's locale is then one that is made in this folder, because a machine may have none. */
bool comma_begin(const char *folder);
void comma_end(void);

#endif
