/* SPDX-License-Identifier: MIT */
/* How much a command has written, in words. */
#ifndef MERLIN_CLI_WRITTEN_H
#define MERLIN_CLI_WRITTEN_H

#include "base/staging.h"

enum { WRITTEN_WORDS = 64 };

/* Puts "9 files, 84 MB" into words, which it returns; kB, MB and GB are powers of 1000, as in a file manager. */
const char *written_words(const staged_files *written, char words[WRITTEN_WORDS]);

#endif
