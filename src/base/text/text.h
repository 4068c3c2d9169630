/* SPDX-License-Identifier: MIT */
/* Decodes text of any system: into UTF-8 without a byte order mark, each line ended by one '\n'.
 *
 *     char *text;
 *     status s = text_decode(bytes, size, "lights.txt", &text);
 *     ... strchr(text, '\n') ...
 *     free(text);
 */
#ifndef MERLIN_BASE_TEXT_TEXT_H
#define MERLIN_BASE_TEXT_TEXT_H

#include <stddef.h>

#include "base/status.h"

/* Decodes UTF-16 (recognized by its byte order mark, or by zeros in every other one of the first bytes); other bytes
 * are kept as they are if none is zero. The minus sign U+2212 and the no-break space become '-' and ' '. Refuses zero
 * bytes, naming the line; `where` is put in front of messages. *out is malloc'ed and ends in a zero. */
status text_decode(const char *bytes, size_t size, const char *where, char **out);

#endif
