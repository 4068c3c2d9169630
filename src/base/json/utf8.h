/* SPDX-License-Identifier: MIT */
/* Text of unknown encoding, such as a file's name, for files that must hold UTF-8. */
#ifndef MERLIN_BASE_JSON_UTF8_H
#define MERLIN_BASE_JSON_UTF8_H

/* Returns a copy in which every byte that is not UTF-8 is replaced by U+FFFD; malloc'ed, NULL if memory ran out. */
char *utf8_valid(const char *text);

#endif
