/* SPDX-License-Identifier: MIT */
/* One line and exit status 1 where a library ends the program, or crashes, because the system refused it memory or a
 * thread; what was being written is removed. Any other crash stays one. */
#ifndef MERLIN_COMMAND_LAST_WORDS_H
#define MERLIN_COMMAND_LAST_WORDS_H

/* First in a command; the name must stay. Does nothing in builds with sanitizers. */
void last_words_prepare(const char *command);

#endif
