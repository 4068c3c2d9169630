/* SPDX-License-Identifier: MIT */
/* Lines for people, and none of other libraries between them: what decoders think of a damaged picture they print to
 * standard error, five lines for one file. A program that asks for it has a stream of its own to the same place, while
 * standard error leads nowhere as long as any thread is in a decoder.
 *
 *     messages_keep();                                first in main; without it messages() is stderr, and hushing does
 * nothing fprintf(messages(), "merlin: %s\n", words); messages_hush(); decode(...); fprintf(stderr, ...) in here is
 * lost messages_unhush();
 */
#ifndef MERLIN_BASE_MESSAGES_H
#define MERLIN_BASE_MESSAGES_H

#include <stdio.h>

/* Does nothing in builds with sanitizers, whose reports must be seen, and where the environment sets
 * MERLIN_LIBRARY_MESSAGES. */
void messages_keep(void);
FILE *messages(void);
/* Whose lines they are: each begins with the program's name, "merlin" if none was set. A literal. */
void messages_set_program(const char *name);
const char *messages_program(void);

/* Any thread, in pairs. */
void messages_hush(void);
void messages_unhush(void);

#endif
