/* SPDX-License-Identifier: MIT */
/* Prints one line and exits with status 1 if a library ends the program, or crashes, because the system refused it
 * memory or a thread; partial output is removed. Other crashes are unchanged. */
#ifndef MERLIN_COMMAND_LAST_WORDS_H
#define MERLIN_COMMAND_LAST_WORDS_H

/* Installs the handlers, first in a command; the name must stay valid. Does nothing in builds with sanitizers. */
void last_words_prepare(const char *command);

#endif
