/* SPDX-License-Identifier: MIT */
/* A photograph that is piped in, "-" in a file's place (a file of that name is ./-).
 *
 *     status s = standard_input_take(&argv[i]);        a name that every reader takes, for as long as the program runs
 */
#ifndef MERLIN_COMMAND_STANDARD_INPUT_H
#define MERLIN_COMMAND_STANDARD_INPUT_H

#include <stdbool.h>

#include "base/status.h"

/* Keeps all of standard input in memory, at most half a gigabyte, if the argument is "-", which then names what was
 * kept; other arguments stay. */
status standard_input_take(char **argument);
bool standard_input_is(const char *path);
/* Returns "standard input" for what was kept, else the path. */
const char *standard_input_name(const char *path);
/* Writes a message with standard input called so, cut at `size`. */
void standard_input_tell(const char *message, char *out, int size);

#endif
