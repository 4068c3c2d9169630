/* SPDX-License-Identifier: MIT */
/* Text of unknown bytes, such as a file's name, as text for files that want UTF-8. */
#ifndef MERLIN_BASE_UTF8_H
#define MERLIN_BASE_UTF8_H

/* A copy in which every byte that is not UTF-8 is U+FFFD; malloc'ed, NULL if memory ran out. */
char *utf8_valid(const char *text);

#endif
