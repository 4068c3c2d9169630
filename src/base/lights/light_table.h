/* SPDX-License-Identifier: MIT */
/* What is in which column of a list of lights: a part of base/lights/light_list.h. */
#ifndef MERLIN_BASE_LIGHTS_LIGHT_TABLE_H
#define MERLIN_BASE_LIGHTS_LIGHT_TABLE_H

#include "base/lights/light_list.h"
#include "base/text/text_rows.h"

/* The list's rows, what stands before them, and what it becomes. */
typedef struct light_table {
    const char *where;
    const text_row *row; /* of lights alone */
    size_t count;
    const text_row *header; /* a line of words, or a comment, right before them; NULL without */
    long announced;         /* the count in a line of its own; 0 without */
    light_list *list;
} light_table;

/* One light's words: the name's raw text, NULL without, and x y z, then one or three intensities if there are any. */
typedef struct light_words {
    const char *name;
    size_t name_length;
    const text_word *number[6];
    size_t count; /* of number: 3, 4 or 6 */
    int line;
} light_words;

/* Adds one light; refuses what is not finite or out of range. */
status light_table_add(light_table *t, const light_words *words);
/* Adds one more sentence to the list's note. */
void light_table_note(light_table *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Reads the columns that the header names; *done is false where it does not name those of a light, or the rows have
 * other ones. */
status light_table_by_header(light_table *t, bool *done);
/* Reads the columns by where words and numbers stand. */
status light_table_by_place(light_table *t);

/* Tells whether a word ends as a file's name does, in a dot and a few letters. */
bool light_table_is_file(const char *name, size_t length);

#endif
