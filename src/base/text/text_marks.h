/* SPDX-License-Identifier: MIT */
/* What the signs of a table of numbers mean where they stand: comments, quotes, and brackets round rows and round all.
 * A part of base/text/text_rows.h. */
#ifndef MERLIN_BASE_TEXT_TEXT_MARKS_H
#define MERLIN_BASE_TEXT_TEXT_MARKS_H

#include <stdbool.h>
#include <stddef.h>

typedef enum text_mark {
    MARK_NONE,
    MARK_COMMENT,  /* any sign of a comment */
    MARK_QUOTE,    /* the sign that begins or ends a quotation */
    MARK_QUOTED,   /* any sign inside one */
    MARK_OPEN,     /* a bracket round others */
    MARK_CLOSE,    /* its end */
    MARK_OPEN_ROW, /* a bracket with numbers in it and no other bracket */
    MARK_CLOSE_ROW /* its end */
} text_mark;

/* Marks the size signs of a decoded text; marks must be as many MARK_NONE. */
void text_mark_all(const char *text, size_t size, unsigned char *marks);

static inline bool text_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\v' || c == '\f';
}

#endif
