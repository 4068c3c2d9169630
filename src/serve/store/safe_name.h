/* SPDX-License-Identifier: MIT */
/* File names that clients send, made harmless. */
#ifndef MERLIN_SERVE_STORE_SAFE_NAME_H
#define MERLIN_SERVE_STORE_SAFE_NAME_H

#include <stddef.h>

/* Room for a safe name and its zero. */
enum { SAFE_NAME = 128 };

/* Makes a plain file's name of whatever a client calls its file: what follows the last slash or backslash, without dots
 * at its beginning, with an underscore for what is neither letter, digit, dot, dash, underscore, space nor beyond
 * ASCII; the middle of a long one is left out, so that its ending stays. Never empty. */
void safe_name(const char *given, char name[SAFE_NAME]);
/* Puts "N-" in front, for the N-th file of a name that is taken. */
void safe_name_number(char name[SAFE_NAME], size_t number);

#endif
