/* SPDX-License-Identifier: MIT */
/* Suggests the command or option that was meant by a mistyped one.
 *
 *     const char *meant = suggest("esitmate", 8, names, count);     "estimate", or NULL if none is similar */
#ifndef MERLIN_COMMAND_SUGGEST_H
#define MERLIN_COMMAND_SUGGEST_H

#include <stddef.h>

/* Returns the name with the least distance from the first `length` characters of the word: letters left out, added,
 * replaced or exchanged with the next, at most one for every three letters. The first of several equally close ones. */
const char *suggest(const char *word, size_t length, const char *const *names, size_t count);

#endif
