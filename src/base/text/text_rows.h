/* SPDX-License-Identifier: MIT */
/* Tables of words and numbers as people and programs write them: one row a line.
 *
 *     text_rows rows;
 *     status s = text_rows_parse(bytes, size, "lights.csv", &rows);
 *     for (size_t i = 0; i < rows.count; i++)
 *         if (rows.row[i].count && rows.row[i].word[0].kind == TEXT_NUMBER) use(rows.row[i].word[0].value);
 *     text_rows_free(&rows);
 *
 * Any encoding that text_decode knows. Blanks, tabs, commas and semicolons part words, also several, also at a line's
 * end. A comma is a decimal one where blanks, tabs or semicolons part the numbers, or in quotations. Quotations are
 * words, whatever is in them. Rows may stand in brackets, and all of them in others, as programs print matrices; then a
 * row is what is in the inner ones, or in [ ] ends with a semicolon. Comments begin with #, % or // at the beginning of
 * a line or behind a blank, or with a semicolon at the beginning of one; a comment that is all of a line is a row of
 * its own, for it may name columns. Empty lines are none. */
#ifndef MERLIN_BASE_TEXT_TEXT_ROWS_H
#define MERLIN_BASE_TEXT_TEXT_ROWS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "base/text/text_number.h"

typedef struct text_word {
    const char *at; /* in the text, without quotes and what parts words; no zero behind it */
    size_t length;
    text_kind kind;
    double value; /* of a number */
    bool apart;   /* a line's beginning, a comma, a semicolon or a tab stands before it: it begins a field */
} text_word;

typedef struct text_row {
    text_word *word;
    size_t count; /* above 0 */
    int line;     /* from 1 on */
    bool comment;
    bool mixed; /* commas part some of its numbers, and blanks alone others */
} text_row;

typedef struct text_rows {
    char *text;
    text_word *word;
    text_row *row;
    size_t count;
} text_rows;

/* Refuses what is no text, words of more than 1023 bytes and commas that may be either; messages carry `where` and the
 * line's number. */
status text_rows_parse(const char *bytes, size_t size, const char *where, text_rows *out);
void text_rows_free(text_rows *rows);

#endif
