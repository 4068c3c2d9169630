/* SPDX-License-Identifier: MIT */
/* A photograph from standard input, "-" instead of a file (a file of that name is ./-).
 *
 *     status s = standard_input_take(&argv[i]);        becomes a name that every reader accepts, until the program ends
 */
#ifndef MERLIN_COMMAND_STANDARD_INPUT_H
#define MERLIN_COMMAND_STANDARD_INPUT_H

#include <stdbool.h>

#include "base/status.h"

/* Stores all of standard input in memory, at most half a gigabyte, if the argument is "-", which then names it; other
 * arguments are unchanged. */
status standard_input_take(char **argument);
bool standard_input_is(const char *path);
/* Returns "standard input" for the stored input, else the path. */
const char *standard_input_name(const char *path);
/* Copies a message with standard input's name replaced, cut at `size`. */
void standard_input_tell(const char *message, char *out, int size);

#endif
