/* SPDX-License-Identifier: MIT */
/* Reads lists of lights: the lines before the lights, and the list as a whole. The columns are read by the functions of
 * base/lights/light_parser.h. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/lights/light_parser.h"

enum { FILE_MAX_SIZE = 1 << 22 };

/* ---- lines before the lights ---- */

static bool is_whole(const text_word *w)
{
    for (size_t i = 0; i < w->length; i++)
        if (!isdigit((unsigned char)w->at[i])) return false;
    return w->length > 0;
}

/* Tells whether a row is a heading: words, and perhaps whole numbers that count something, but neither a light's
 * numbers nor a picture's name. */
static bool is_heading(const text_row *r)
{
    const text_word *w = r->word;
    if (text_is_number_like(&w[0])) return false;
    size_t n = r->count;
    if (n > 3 && text_is_number_like(&w[n - 1]) && text_is_number_like(&w[n - 2]) && text_is_number_like(&w[n - 3]))
        return false;
    for (size_t i = 0; i < n; i++) {
        if (text_is_number_like(&w[i]) && !is_whole(&w[i])) return false;
        if (light_parser_is_file_name(w[i].at, w[i].length)) return false;
    }
    return true;
}

/* Takes a line with a single whole number as the count of an .lp file. */
static status take_count(light_parser *t, const text_row *r)
{
    const text_word *w = r->word;
    int length = w->length < 40 ? (int)w->length : 40;
    if (!is_whole(w) || !(w->value >= 1))
        return fail(MERLIN_BAD_INPUT, "%s:%d: expected x y z or a count of lights, found \"%.*s\"", t->where, r->line,
                    length, w->at);
    if (w->value > LIGHT_LIST_MAX)
        return fail(MERLIN_BAD_INPUT, "%s:%d: %.*s lights are more than %d", t->where, r->line, length, w->at,
                    LIGHT_LIST_MAX);
    t->announced = (long)w->value;
    return OK;
}

/* Skips title, count, column names and comments, so that only lights are left. */
static status take_head(light_parser *t)
{
    for (; t->count; t->row++, t->count--) {
        const text_row *r = t->row;
        if (r->comment || is_heading(r)) {
            if (!r->comment || !t->header || t->header->comment) t->header = r;
        } else if (r->count == 1 && t->announced == 0) {
            status s = take_count(t, r);
            if (s != OK) return s;
        } else {
            return OK;
        }
    }
    return OK;
}

/* ---- the whole list ---- */

/* Allocates the arrays for `count` lights, optional ones too, as lists are short. */
static status make_room(light_list *list, size_t count)
{
    list->at = calloc(count, sizeof *list->at);
    list->name = calloc(count, sizeof *list->name);
    list->intensity = calloc(count, sizeof *list->intensity);
    list->line = calloc(count, sizeof *list->line);
    if (list->at && list->name && list->intensity && list->line) return OK;
    return fail(MERLIN_NO_MEMORY, "no memory for %zu lights", count);
}

static bool has_names(const light_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        if (list->name[i][0]) return true;
    return false;
}

static status check_names(const light_parser *t)
{
    const light_list *list = t->list;
    for (size_t i = 0; i < list->count; i++)
        if (!list->name[i][0])
            return fail(MERLIN_BAD_INPUT, "%s:%d: no name of a picture, where other lines have one", t->where,
                        list->line[i]);
    return OK;
}

static bool are_equally_strong(const light_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        if (vec3_length(vec3_sub(list->intensity[i], vec3_make(1, 1, 1))) > 0) return false;
    return true;
}

static void forget_names(light_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->name[i]);
    free(list->name);
    list->name = NULL;
}

static status check_directions(const light_parser *t)
{
    const light_list *list = t->list;
    for (size_t i = 0; i < list->count; i++)
        if (!(vec3_length(list->at[i]) > (real)1e-6))
            return fail(MERLIN_BAD_INPUT, "%s:%d: the direction has no length", t->where, list->line[i]);
    return OK;
}

/* Compares the number of lights with the announced count; the message names the last light, where the file may have
 * been cut. */
static status check_count(const light_parser *t)
{
    const light_list *list = t->list;
    if (t->announced == 0 || (size_t)t->announced == list->count) return OK;
    const char *name = list->name ? list->name[list->count - 1] : "";
    return fail(MERLIN_BAD_INPUT, "%s: the first line says %ld light%s, but there %s %zu%s%.80s: correct that number",
                t->where, t->announced, t->announced == 1 ? "" : "s", list->count == 1 ? "is" : "are", list->count,
                *name ? ", the last one for " : "", name);
}

static status take_lights(light_parser *t)
{
    light_list *list = t->list;
    bool done = false;
    status s = make_room(list, t->count > 3 ? t->count : LIGHT_LIST_MAX);
    if (s == OK && t->header) s = light_parser_by_header(t, &done);
    if (s == OK && !done) s = light_parser_by_place(t);
    if (s != OK) return s;
    if (are_equally_strong(list)) {
        free(list->intensity);
        list->intensity = NULL;
    }
    if (!has_names(list))
        forget_names(list);
    else if ((s = check_names(t)) != OK)
        return s;
    list->about_object = t->announced > 0 || file_ends_in(t->where, ".lp");
    if (list->about_object || list->angles) s = check_directions(t);
    return s == OK ? check_count(t) : s;
}

/* Copies the rows, leaving out lines that are only comments. */
static status without_comments(const light_parser *t, text_row **out)
{
    text_row *kept = malloc((t->count + 1) * sizeof *kept);
    if (!kept) return fail(MERLIN_NO_MEMORY, "no memory for %s", t->where);
    size_t count = 0;
    for (size_t i = 0; i < t->count; i++)
        if (!t->row[i].comment) kept[count++] = t->row[i];
    *out = kept;
    return count <= LIGHT_LIST_MAX ? OK : fail(MERLIN_BAD_INPUT, "%s: more than %d lights", t->where, LIGHT_LIST_MAX);
}

static status take_rows(const text_rows *rows, const char *where, light_list *out)
{
    light_parser t = {.where = where, .row = rows->row, .count = rows->count, .list = out};
    status s = take_head(&t);
    if (s == OK && t.count == 0) s = fail(MERLIN_BAD_INPUT, "%s: no lights in it (expected x y z a line)", where);
    text_row *kept = NULL;
    if (s == OK) s = without_comments(&t, &kept);
    if (s == OK) {
        size_t count = 0;
        for (size_t i = 0; i < t.count; i++)
            count += !t.row[i].comment;
        t.row = kept;
        t.count = count;
        s = take_lights(&t);
    }
    free(kept);
    return s;
}

status light_list_parse(const char *text, size_t size, const char *where, light_list *out)
{
    *out = (light_list){0};
    text_rows rows;
    status s = text_rows_parse(text, size, where, &rows);
    if (s != OK) return s;
    s = take_rows(&rows, where, out);
    text_rows_free(&rows);
    if (s != OK) light_list_free(out);
    return s;
}

status light_list_read(const char *path, light_list *out)
{
    *out = (light_list){0};
    char *text;
    size_t size;
    status s = file_read(path, FILE_MAX_SIZE, &text, &size);
    if (s != OK) return s;
    s = light_list_parse(text, size, path, out);
    free(text);
    return s;
}
