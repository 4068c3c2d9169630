/* SPDX-License-Identifier: MIT */
/* Makes file names of clients harmless. */
#ifndef MERLIN_SERVE_STORE_SAFE_NAME_H
#define MERLIN_SERVE_STORE_SAFE_NAME_H

#include <stddef.h>

/* Size of a safe name with its zero. */
enum { SAFE_NAME = 128 };

/* Makes a plain file name from a client's: the part after the last slash or backslash, without leading dots, with an
 * underscore instead of everything that is neither letter, digit, dot, dash, underscore, space nor beyond ASCII; long
 * names are shortened in the middle, so that the ending remains. Never empty. */
void safe_name(const char *given, char name[SAFE_NAME]);
/* Puts "N-" in front, for the N-th file of the same name. */
void safe_name_number(char name[SAFE_NAME], size_t number);

#endif
