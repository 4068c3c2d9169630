/* SPDX-License-Identifier: MIT */
/* Text as programs of all systems write it, made plain: UTF-8 without a mark, each line ended by one '\n'.
 *
 *     char *text;
 *     status s = text_decode(bytes, size, "lights.txt", &text);
 *     ... strchr(text, '\n') ...
 *     free(text); */
#ifndef MERLIN_BASE_TEXT_TEXT_H
#define MERLIN_BASE_TEXT_TEXT_H

#include <stddef.h>

#include "base/status.h"

/* Decodes UTF-16 (by its mark, or where every other one of the first bytes is zero) and any bytes without a zero, of
 * which UTF-8 alone is understood; the minus sign and the blank that does not break become '-' and ' '. Refuses zeros
 * with their line's number; `where` is put in front of messages. *out is malloc'ed and ends in a zero. */
status text_decode(const char *bytes, size_t size, const char *where, char **out);

#endif
