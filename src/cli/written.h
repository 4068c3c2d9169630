/* SPDX-License-Identifier: MIT */
/* Questions about the files that a command has written. */
#ifndef MERLIN_CLI_WRITTEN_H
#define MERLIN_CLI_WRITTEN_H

#include <stdbool.h>

#include "base/staging.h"

/* Tells whether a file of the same name, whatever its folder, was written. */
bool written_has(const staged_files *written, const char *name);

enum { WRITTEN_WORDS = 64 };

/* Puts "9 files, 84 MB" into words, which it returns; kB, MB and GB are powers of 1000, as in a file manager. */
const char *written_words(const staged_files *written, char words[WRITTEN_WORDS]);

#endif
