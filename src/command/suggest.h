/* SPDX-License-Identifier: MIT */
/* What somebody meant who mistyped a command or an option.
 *
 *     const char *meant = suggest("esitmate", 8, names, count);     "estimate", or NULL if nothing is near */
#ifndef MERLIN_COMMAND_SUGGEST_H
#define MERLIN_COMMAND_SUGGEST_H

#include <stddef.h>

/* Returns the one of the names that is the fewest slips away from the first `length` characters of the word: letters
 * left out, added, replaced or exchanged with the next, one for every three letters. The first of several as near. */
const char *suggest(const char *word, size_t length, const char *const *names, size_t count);

#endif
