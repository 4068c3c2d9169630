/* SPDX-License-Identifier: MIT */
/* Tables of words and numbers as people and programs write them: one row a line.
 *
 *     text_rows rows;
 *     status s = text_rows_parse(bytes, size, "lights.csv", &rows);
 *     for (size_t i = 0; i < rows.count; i++)
 *         if (rows.row[i].count && rows.row[i].word[0].kind == TEXT_NUMBER) use(rows.row[i].word[0].value);
 *     text_rows_free(&rows);
 *
 * Any encoding that text_decode knows. Words are separated by spaces, tabs, commas and semicolons, also several, also
 * at a line's end. A comma is a decimal point where spaces, tabs or semicolons separate the numbers, and in quotations.
 * A quotation is one word, whatever it contains. Rows may be in brackets, and the table in outer ones, as programs
 * print matrices; then a row is what the inner brackets enclose, or in [ ] ends with a semicolon. Comments begin with
 * #, % or // at the beginning of a line or after a space, or with a semicolon at the beginning of one; a comment that
 * fills its line is a row of its own, as it may name columns. Empty lines are skipped. */
#ifndef MERLIN_BASE_TEXT_TEXT_ROWS_H
#define MERLIN_BASE_TEXT_TEXT_ROWS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "base/text/text_number.h"

typedef struct text_word {
    const char *at; /* points into the text, without quotes and separators; not zero-terminated */
    size_t length;
    text_kind kind;
    double value; /* value of a number */
    bool apart;   /* a new field: the word follows a line's beginning, a comma, a semicolon or a tab */
} text_word;

typedef struct text_row {
    text_word *word;
    size_t count; /* at least 1 */
    int line;     /* line number, from 1 */
    bool comment;
    bool mixed; /* commas separate some of its numbers, only spaces others */
} text_row;

typedef struct text_rows {
    char *text;
    text_word *word;
    text_row *row;
    size_t count;
} text_rows;

/* Parses a table. Refuses binary data, words of more than 1023 bytes and ambiguous commas; messages carry `where` and
 * the line's number. */
status text_rows_parse(const char *bytes, size_t size, const char *where, text_rows *out);
void text_rows_free(text_rows *rows);

/* Tells whether a word is a number, finite or not. */
static inline bool text_is_number_like(const text_word *w)
{
    return w->kind != TEXT_WORD;
}

#endif
