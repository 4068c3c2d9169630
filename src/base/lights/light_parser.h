/* SPDX-License-Identifier: MIT */
/* State of reading a list of lights, and its steps: a part of base/lights/light_list.h. */
#ifndef MERLIN_BASE_LIGHTS_LIGHT_PARSER_H
#define MERLIN_BASE_LIGHTS_LIGHT_PARSER_H

#include "base/lights/light_list.h"
#include "base/text/text_rows.h"

/* The list's rows, what precedes them, and the list being filled. */
typedef struct light_parser {
    const char *where;
    const text_row *row; /* rows of lights only */
    size_t count;
    const text_row *header; /* row of words, or comment, right before the lights; NULL without */
    long announced;         /* count announced in a line of its own; 0 without */
    light_list *list;
} light_parser;

/* The words of one light: the name's raw text or NULL, and x y z, perhaps followed by one or three intensities. */
typedef struct light_entry {
    const char *name;
    size_t name_length;
    const text_word *number[6];
    size_t count; /* count of numbers: 3, 4 or 6 */
    int line;
} light_entry;

/* Adds one light; refuses numbers that are not finite or out of range. */
status light_parser_add(light_parser *t, const light_entry *words);
/* Appends a sentence to the list's note. */
void light_parser_note(light_parser *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Reads the columns that the header names; *done is false if it does not name those of a light, or if the rows have
 * others. */
status light_parser_by_header(light_parser *t, bool *done);
/* Reads the columns by where words and numbers stand. */
status light_parser_by_place(light_parser *t);

/* Tells whether a word ends as a file's name does, in a dot and a few letters. */
bool light_parser_is_file_name(const char *name, size_t length);

#endif
