/* SPDX-License-Identifier: MIT */
/* Messages for people, without those that other libraries print: decoders report a damaged picture on standard error,
 * up to five lines a file. A program that calls messages_keep gets a stream of its own to the same place, and standard
 * error is redirected to nowhere as long as any thread is in a decoder.
 *
 *     messages_keep();      first in main; without it messages() is stderr, and muting does nothing
 *     fprintf(messages(), "merlin: %s\n", words);
 *     messages_mute();
 *     decode(...);          what it prints to stderr is dropped
 *     messages_unmute();
 */
#ifndef MERLIN_BASE_MESSAGES_H
#define MERLIN_BASE_MESSAGES_H

#include <stdio.h>

/* Opens the stream. Does nothing in builds with sanitizers, whose reports must be seen, nor if the environment sets
 * MERLIN_LIBRARY_MESSAGES. */
void messages_keep(void);
FILE *messages(void);
/* Sets the program's name with which messages begin, a literal; "merlin" unless set. */
void messages_set_program(const char *name);
const char *messages_program(void);

/* Keeps a text to one line, in place: names of files may contain line breaks. */
void messages_one_line(char *text);

/* Mute and unmute standard error for all threads; may be called from any thread, in pairs. */
void messages_mute(void);
void messages_unmute(void);

#endif
