/* SPDX-License-Identifier: MIT */
/* Columns of a list of lights without a header: recognized by where words and numbers stand, and by the numbers'
 * values. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/lights/light_parser.h"

enum { MOST_WORDS = 7 };
/* tolerance of a unit direction's length, for rounded directions */
static const double unit_tolerance = 0.02;

/* The numbers of a row: its last words, or its first ones if a name follows them. */
typedef struct run {
    size_t first, count;
    bool name_behind;
} run;

static run run_of(const text_row *r)
{
    size_t first = r->count, ahead = 0;
    while (first > 0 && text_is_number_like(&r->word[first - 1]))
        first--;
    while (ahead < r->count && text_is_number_like(&r->word[ahead]))
        ahead++;
    if (r->count - first >= 3 || ahead < 3) return (run){first, r->count - first, false};
    return (run){0, ahead, true};
}

static bool is_all_numbers(const text_row *r)
{
    run numbers = run_of(r);
    return numbers.count == r->count;
}

static bool are_all_numbers(const light_parser *t)
{
    for (size_t i = 0; i < t->count; i++)
        if (!is_all_numbers(&t->row[i])) return false;
    return true;
}

/* Refuses a row, naming the first word that should have been a number if that is all that is wrong. */
static status refuse_row(const light_parser *t, const text_row *r)
{
    for (size_t i = 1; i < r->count && r->count <= MOST_WORDS; i++) {
        const text_word *w = &r->word[i];
        bool beside =
            text_is_number_like(&r->word[i - 1]) || (i + 1 < r->count && text_is_number_like(&r->word[i + 1]));
        if (r->count >= 3 && !text_is_number_like(w) && beside)
            return fail(MERLIN_BAD_INPUT, "%s:%d: \"%.*s\" is not a finite number; expected x y z", t->where, r->line,
                        (int)(w->length < 40 ? w->length : 40), w->at);
    }
    if (r->count == 2 && is_all_numbers(r))
        return fail(MERLIN_BAD_INPUT,
                    "%s:%d: expected x y z, found 2 numbers; angles want a line before them that says \"azimuth deg, "
                    "elevation deg\"",
                    t->where, r->line);
    return fail(MERLIN_BAD_INPUT, "%s:%d: expected x y z, found %zu word%s", t->where, r->line, r->count,
                r->count == 1 ? "" : "s");
}

/* ---- one light a column ---- */

static double length_of(const text_word *const at[3])
{
    return sqrt(at[0]->value * at[0]->value + at[1]->value * at[1]->value + at[2]->value * at[2]->value);
}

static bool has_unit_rows(const light_parser *t)
{
    for (size_t i = 0; i < t->count; i++) {
        const text_word *w = t->row[i].word;
        if (fabs(length_of((const text_word *const[]){w, w + 1, w + 2}) - 1) > unit_tolerance) return false;
    }
    return true;
}

/* Tells whether three rows of n words hold unit vectors, one a column. */
static bool has_unit_columns(const light_parser *t, size_t first, size_t n)
{
    for (size_t k = first; k < first + n; k++) {
        const text_word *const at[3] = {&t->row[0].word[k], &t->row[1].word[k], &t->row[2].word[k]};
        if (fabs(length_of(at) - 1) > unit_tolerance) return false;
    }
    return true;
}

static bool is_axis(const text_word *w, char axis)
{
    return w->length > 0 && w->length <= 2 && (w->length == 1 || strchr("lLdDnN", w->at[0])) &&
           tolower((unsigned char)w->at[w->length - 1]) == axis;
}

static status add_columns(light_parser *t, size_t first)
{
    const text_row *r = t->row;
    size_t n = r[0].count - first;
    if (n > LIGHT_LIST_MAX)
        return fail(MERLIN_BAD_INPUT, "%s: %zu lights are more than %d", t->where, n, LIGHT_LIST_MAX);
    status s = OK;
    for (size_t k = first; k < first + n && s == OK; k++) {
        light_entry w = {.number = {&r[0].word[k], &r[1].word[k], &r[2].word[k]}, .count = 3, .line = r[0].line};
        s = light_parser_add(t, &w);
    }
    return s;
}

static bool is_whole_of(const text_word *w, double value)
{
    return w->kind == TEXT_NUMBER && w->value == value;
}

/* Tells whether a column numbers the lights from 0 or 1, in any order. */
static bool is_index(const light_parser *t, size_t column)
{
    bool zero = false, sound = t->count > 1;
    bool *seen = calloc(t->count + 1, sizeof *seen);
    if (!seen) return false;
    for (size_t i = 0; i < t->count; i++)
        zero = zero || is_whole_of(&t->row[i].word[run_of(&t->row[i]).first + column], 0);
    for (size_t i = 0; i < t->count && sound; i++) {
        const text_word *w = &t->row[i].word[run_of(&t->row[i]).first + column];
        double value = w->value + (zero ? 1 : 0);
        sound = w->kind == TEXT_NUMBER && value >= 1 && value <= (double)t->count && is_whole_of(w, floor(w->value)) &&
                !seen[(size_t)value];
        if (sound) seen[(size_t)value] = true;
    }
    free(seen);
    return sound;
}

/* Reads x, y and z from a line each, one light a column. Three lights with intensities look the same; unit lengths tell
 * which it is. */
static status by_columns(light_parser *t, bool *done)
{
    const text_row *r = t->row;
    *done = false;
    if (t->count != 3 || r[0].count != r[1].count || r[1].count != r[2].count) return OK;
    size_t n = r[0].count;
    bool labels = n > 3 && is_axis(&r[0].word[0], 'x') && is_axis(&r[1].word[0], 'y') && is_axis(&r[2].word[0], 'z');
    if (labels) {
        for (int k = 0; k < 3; k++)
            if (run_of(&r[k]).count != n - 1) return OK;
        *done = true;
        return add_columns(t, 1);
    }
    if (n < 4 || !are_all_numbers(t) || is_index(t, 0)) return OK;
    bool known = t->announced > 0, columns = known ? (size_t)t->announced == n : n == 5 || n > 6;
    if (!known && !columns) {
        bool units = has_unit_rows(t);
        columns = has_unit_columns(t, 0, n);
        if (units == columns)
            return fail(MERLIN_BAD_INPUT,
                        "%s: 3 lines of %zu numbers may be 3 lights with strengths or %zu lights in columns; write x y "
                        "z a line",
                        t->where, n, n);
    }
    if (!columns) return OK;
    *done = true;
    return add_columns(t, 0);
}

/* ---- one light a line ---- */

static int by_text(const void *a, const void *b)
{
    const light_entry *one = a, *other = b;
    size_t least = one->name_length < other->name_length ? one->name_length : other->name_length;
    int order = memcmp(one->name, other->name, least);
    return order ? order : (one->name_length > other->name_length) - (one->name_length < other->name_length);
}

static void set_name(light_entry *w, const text_row *r, size_t first, size_t end)
{
    if (first == end) return;
    const text_word *last = &r->word[end - 1];
    w->name = r->word[first].at;
    w->name_length = (size_t)(last->at + last->length - w->name);
}

/* Sets *distinct to whether no two rows have the same name before their numbers. */
static status have_distinct_names(const light_parser *t, bool *distinct)
{
    light_entry *all = calloc(t->count, sizeof *all);
    if (!all) return fail(MERLIN_NO_MEMORY, "no memory for %zu names", t->count);
    for (size_t i = 0; i < t->count; i++)
        set_name(&all[i], &t->row[i], 0, run_of(&t->row[i]).first);
    qsort(all, t->count, sizeof *all, by_text);
    *distinct = true;
    for (size_t i = 1; i < t->count; i++)
        *distinct = *distinct && by_text(&all[i - 1], &all[i]) != 0;
    free(all);
    return OK;
}

/* Tells whether in all rows the name before the numbers is separated from them by more than spaces, or ends in an
 * extension. */
static bool are_names_apart(const light_parser *t)
{
    for (size_t i = 0; i < t->count; i++) {
        const text_row *r = &t->row[i];
        run numbers = run_of(r);
        if (numbers.name_behind) continue;
        if (numbers.first == 0) return false;
        const text_word *last = &r->word[numbers.first - 1];
        if (!r->word[numbers.first].apart && !light_parser_is_file_name(last->at, last->length)) return false;
    }
    return true;
}

/* The columns that all rows share: how many numbers belong to a light, and how many before them do not. */
typedef struct columns {
    size_t numbers, before;
    bool named;        /* those before are part of the name */
    bool index_behind; /* the one after them is the name */
} columns;

/* Tells whether rows of four numbers are distinct whole numbers before unit directions: 15.png may be listed as "15".
 */
static bool are_named_units(const light_parser *t)
{
    for (size_t i = 0; i < t->count; i++) {
        const text_word *w = t->row[i].word;
        if (t->row[i].count != 4 || !is_whole_of(w, floor(fabs(w->value)))) return false;
        if (fabs(length_of((const text_word *const[]){w + 1, w + 2, w + 3}) - 1) > unit_tolerance) return false;
        for (size_t k = 0; k < i; k++)
            if (t->row[k].word->value == w->value) return false;
    }
    return t->count > 1 && !has_unit_rows(t);
}

/* Finds the columns of rows of numbers only: x y z, intensities, and a column that counts or names the picture. */
static status of_numbers(const light_parser *t, size_t n, columns *out)
{
    bool known = n == 3 || (t->announced > 0 && n == 6);
    bool index = !known && n > 3 && (t->announced > 0 || is_index(t, 0) || are_named_units(t));
    bool behind = !known && !index && n > 3 && t->count > 2 && is_index(t, n - 1);
    size_t left = n - index - behind;
    if (left != 3 && left != 4 && left != 6) return refuse_row(t, &t->row[0]);
    *out = (columns){left, index, true, behind};
    return OK;
}

/* Finds the columns of rows with words: in "Light 1 0 0 1" the 1 belongs to the name. */
static status of_words(const light_parser *t, size_t n, columns *out)
{
    bool apart = run_of(&t->row[0]).name_behind || are_names_apart(t), distinct = true;
    status s = apart ? OK : have_distinct_names(t, &distinct);
    if (s != OK) return s;
    bool one_more = n == 4 || n == 5 || n == 7;
    *out = (columns){n, 0, false, false};
    if (one_more && (!distinct || is_index(t, 0)))
        *out = (columns){n - 1, 1, !apart, false};
    else if (n != 3 && n != 4 && n != 6)
        return refuse_row(t, &t->row[0]);
    return OK;
}

static status refuse_other_columns(const light_parser *t, const text_row *r)
{
    if (r->count < 3 || run_of(r).count < 3) return refuse_row(t, r);
    return fail(MERLIN_BAD_INPUT, "%s:%d: %zu words, where the first light has %zu; expected x y z", t->where, r->line,
                r->count, t->row[0].count);
}

/* Finds the columns of rows of different lengths, whose names contain numbers: the last three are x y z. */
static status of_unlike_rows(const light_parser *t, columns *out)
{
    *out = (columns){3, 0, true, false};
    for (size_t i = 0; i < t->count; i++) {
        const text_row *r = &t->row[i];
        run numbers = run_of(r);
        if (numbers.count < 3) return refuse_row(t, r);
        if (numbers.count == 3) continue;
        const text_word *before = numbers.first ? &r->word[numbers.first - 1] : NULL;
        bool named = before && !light_parser_is_file_name(before->at, before->length);
        if (numbers.name_behind || !(named || t->announced > 0)) return refuse_other_columns(t, r);
    }
    return OK;
}

static status find_columns(const light_parser *t, columns *out)
{
    size_t n = run_of(&t->row[0]).count;
    bool alike = true, numbers = are_all_numbers(t);
    for (size_t i = 0; i < t->count; i++) {
        const text_row *r = &t->row[i];
        run these = run_of(r);
        if (these.count < 3) return refuse_row(t, r);
        if (these.name_behind != run_of(&t->row[0]).name_behind) return refuse_other_columns(t, r);
        alike = alike && these.count == n && (these.count == r->count) == numbers;
        if (numbers && these.count != n) return refuse_other_columns(t, r);
    }
    if (!alike) return of_unlike_rows(t, out);
    return numbers ? of_numbers(t, n, out) : of_words(t, n, out);
}

/* Returns the index of a row's first number that belongs to the light. */
static size_t first_number(const text_row *r, const columns *c)
{
    run numbers = run_of(r);
    return c->index_behind ? numbers.first : numbers.first + (numbers.count - c->numbers);
}

static status add_row(light_parser *t, const text_row *r, const columns *c)
{
    run numbers = run_of(r);
    light_entry w = {.count = c->numbers, .line = r->line};
    size_t first = first_number(r, c);
    if (c->index_behind)
        set_name(&w, r, first + c->numbers, r->count);
    else if (numbers.name_behind)
        set_name(&w, r, numbers.count, r->count);
    else
        set_name(&w, r, 0, c->named ? first : numbers.first);
    for (size_t k = 0; k < c->numbers; k++)
        w.number[k] = &r->word[first + k];
    return light_parser_add(t, &w);
}

/* Tells whether a word is a whole number, a comma and digits, as 0,25 is written. */
static bool is_pair(const text_word *w)
{
    return w[1].at == w[0].at + w[0].length + 1 && w[1].at[-1] == ',' && isdigit((unsigned char)*w[1].at) &&
           !memchr(w[0].at, '.', w[0].length) && !memchr(w[1].at, '.', w[1].length);
}

/* Tells whether six numbers such as 0,6,0,0,0,8 may be a direction with decimal commas. */
static bool are_pairs(const text_word *w)
{
    double sum = 0;
    for (size_t k = 0; k < 6; k += 2) {
        if (!is_pair(w + k)) return false;
        double value = fabs(w[k].value) + w[k + 1].value / pow(10, (double)w[k + 1].length);
        sum += value * value;
    }
    return fabs(sqrt(sum) - 1) < unit_tolerance;
}

/* Refuses rows that mix commas and spaces inconsistently, and six numbers that may be three with decimal commas. */
static status check_strengths(const light_parser *t, const columns *c)
{
    bool pairs = c->numbers == 6;
    for (size_t i = 0; i < t->count; i++) {
        const text_row *r = &t->row[i];
        if (r->mixed)
            return fail(MERLIN_BAD_INPUT,
                        "%s:%d: commas part some of the numbers and blanks others; write decimal points", t->where,
                        r->line);
        pairs = pairs && are_pairs(&r->word[first_number(r, c)]);
    }
    if (!pairs) return OK;
    return fail(MERLIN_BAD_INPUT, "%s:%d: are these six numbers or three with decimal commas? write decimal points",
                t->where, t->row[0].line);
}

static void doubt_three(light_parser *t)
{
    if (t->count == 3 && t->row[0].count == 3 && has_unit_columns(t, 0, 3) && !has_unit_rows(t))
        light_parser_note(t, "its 3 columns have length 1 and its lines have not: a light is a line, x y z");
}

status light_parser_by_place(light_parser *t)
{
    bool done;
    status s = by_columns(t, &done);
    if (s != OK || done) return s;
    columns c = {0};
    s = find_columns(t, &c);
    if (s == OK && c.numbers > 3) s = check_strengths(t, &c);
    for (size_t i = 0; i < t->count && s == OK; i++)
        s = add_row(t, &t->row[i], &c);
    if (s != OK) return s;
    if (c.numbers > 3)
        light_parser_note(t, "what stands behind x y z was taken for the strength%s of the lights",
                          c.numbers > 4 ? "s in red, green and blue" : "");
    if (are_all_numbers(t)) doubt_three(t);
    return OK;
}
