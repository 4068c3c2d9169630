/* SPDX-License-Identifier: MIT */
/* The meaning of punctuation in a table of numbers: comments, quotes, brackets around rows and around the table. A part
 * of base/text/text_rows.h. */
#ifndef MERLIN_BASE_TEXT_TEXT_MARKS_H
#define MERLIN_BASE_TEXT_TEXT_MARKS_H

#include <stdbool.h>
#include <stddef.h>

typedef enum text_mark {
    MARK_NONE,
    MARK_COMMENT,  /* any character of a comment */
    MARK_QUOTE,    /* the quote that begins or ends a quotation */
    MARK_QUOTED,   /* any character inside one */
    MARK_OPEN,     /* opens a bracket that contains others */
    MARK_CLOSE,    /* closes it */
    MARK_OPEN_ROW, /* opens a bracket that contains numbers and no other bracket */
    MARK_CLOSE_ROW /* closes it */
} text_mark;

/* Marks the `size` characters of a decoded text; marks must be as many MARK_NONE. */
void text_mark_all(const char *text, size_t size, unsigned char *marks);

static inline bool text_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\v' || c == '\f';
}

#endif
