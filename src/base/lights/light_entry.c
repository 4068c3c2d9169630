/* SPDX-License-Identifier: MIT */
/* Reads one light of a list: its numbers, its name, and notes on how they were interpreted. */
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/lights/light_parser.h"

/* Largest coordinate that is accepted: a kilometre in millimetres, whose square is well within a float. */
static const double LARGEST = 1e6;
static const double BRIGHTEST = 1e12;

void light_parser_note(light_parser *t, const char *format, ...)
{
    char *note = t->list->note;
    size_t length = strlen(note);
    if (length) length += (size_t)snprintf(note + length, LIGHT_LIST_NOTE - length, "; ");
    if (length >= LIGHT_LIST_NOTE) return;
    va_list words;
    va_start(words, format);
    vsnprintf(note + length, LIGHT_LIST_NOTE - length, format, words);
    va_end(words);
}

static status take_number(const light_parser *t, const light_entry *w, size_t k, float *out)
{
    const text_word *word = w->number[k];
    int length = word->length < 40 ? (int)word->length : 40;
    if (word->kind != TEXT_NUMBER)
        return fail(MERLIN_BAD_INPUT, "%s:%d: \"%.*s\" is not a finite number", t->where, w->line, length, word->at);
    if (k < 3 && !(fabs(word->value) <= LARGEST))
        return fail(MERLIN_BAD_INPUT, "%s:%d: %.*s is out of range (±%g)", t->where, w->line, length, word->at,
                    LARGEST);
    if (k >= 3 && !((word->value > 0 || (word->value == 0 && w->count > 4)) && word->value < BRIGHTEST))
        return fail(MERLIN_BAD_INPUT, "%s:%d: an intensity must be above zero, not %.*s", t->where, w->line, length,
                    word->at);
    *out = (float)word->value;
    return OK;
}

static status take_name(const light_entry *w, char **out)
{
    *out = strndup(w->name ? w->name : "", w->name ? w->name_length : 0);
    return *out ? OK : fail(MERLIN_NO_MEMORY, "no memory for a name");
}

status light_parser_add(light_parser *t, const light_entry *w)
{
    light_list *list = t->list;
    float v[6] = {0, 0, 0, 1, 1, 1};
    for (size_t k = 0; k < w->count; k++) {
        status s = take_number(t, w, k, &v[k]);
        if (s != OK) return s;
    }
    if (w->count == 4) v[4] = v[5] = v[3];
    if (v[3] + v[4] + v[5] == 0)
        return fail(MERLIN_BAD_INPUT, "%s:%d: the light is black: an intensity must be above zero", t->where, w->line);
    size_t i = list->count;
    list->at[i] = vec3_of(v);
    list->intensity[i] = vec3_of(v + 3);
    list->line[i] = w->line;
    status s = take_name(w, &list->name[i]);
    if (s == OK) list->count++;
    return s;
}

bool light_parser_is_file_name(const char *name, size_t length)
{
    enum { LONGEST_ENDING = 5 };
    size_t letters = 0;
    while (letters < length && isalnum((unsigned char)name[length - 1 - letters]))
        letters++;
    if (letters < 2 || letters > LONGEST_ENDING || letters + 1 >= length) return false;
    const char *ending = name + length - letters;
    return ending[-1] == '.' && isalpha((unsigned char)ending[0]);
}
