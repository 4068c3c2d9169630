/* SPDX-License-Identifier: MIT */
#include "base/lights/light_strengths.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/text/text_rows.h"

enum { TEXT_MOST = 1 << 22 };

/* Returns the number of numeric words at the row's end; 0,95 counts as one. */
static size_t count_numbers(const text_row *r)
{
    size_t first = r->count;
    while (first > 0 && text_is_number_like(&r->word[first - 1]))
        first--;
    return r->count - first;
}

static status take_value(const char *path, int line, const text_word *w, float *out)
{
    if (w->kind != TEXT_NUMBER)
        return fail(MERLIN_BAD_INPUT, "%s:%d: \"%.*s\" is not a finite number", path, line,
                    (int)(w->length < 40 ? w->length : 40), w->at);
    if (!(w->value > 0 && w->value < 1e12))
        return fail(MERLIN_BAD_INPUT, "%s:%d: an intensity must be above zero, not %g", path, line, w->value);
    *out = (float)w->value;
    return OK;
}

/* Reads 0,95, in which only a comma separates digits: an integer, and digits that are not a number of their own. */
static bool take_decimal_comma(const text_row *r, text_word *out)
{
    const text_word *w = r->word;
    if (r->count != 2 || w[1].at != w[0].at + w[0].length + 1 || w[1].at[-1] != ',') return false;
    *out = w[0];
    out->length += 1 + w[1].length;
    out->kind = text_number(out->at, out->length, true, &out->value);
    return isdigit((unsigned char)*w[1].at) && out->kind == TEXT_NUMBER;
}

/* ---- a light per line ---- */

static status find_light(const char *path, const text_row *r, size_t words, const light_strengths *of, size_t *light)
{
    const text_word *last = &r->word[words - 1];
    char *name = strndup(r->word[0].at, (size_t)(last->at + last->length - r->word[0].at));
    if (!name) return fail(MERLIN_NO_MEMORY, "no memory for a name");
    status s = of->find(of->context, name, light);
    if (s == OK && *light >= of->count)
        s = fail(MERLIN_BAD_INPUT, "%s:%d: no picture of %s has the name %.80s", path, r->line, of->where, name);
    free(name);
    return s;
}

static status take_row(const char *path, const text_row *r, size_t next, const light_strengths *of)
{
    size_t count = count_numbers(r), words = r->count - count;
    text_word one;
    const text_word *value = &r->word[words];
    if (take_decimal_comma(r, &one)) {
        value = &one;
        count = 1;
    }
    if (count != 1 && count != 3)
        return fail(MERLIN_BAD_INPUT, "%s:%d: expected one or three intensities, found %zu", path, r->line, count);
    status s = words ? find_light(path, r, words, of, &next) : OK;
    if (s != OK || next >= of->count) return s;
    if (of->value[next][0] > 0)
        return fail(MERLIN_BAD_INPUT, "%s:%d: the intensity of this light is in a line before it already", path,
                    r->line);
    for (size_t k = 0; k < 3 && s == OK; k++)
        s = take_value(path, r->line, &value[count == 3 ? k : 0], &of->value[next][k]);
    return s;
}

/* ---- a light per column ---- */

/* Tells whether the rows have one column per light: one row for all channels, or one for each. */
static bool are_columns(const text_row *const *row, size_t count, size_t lights)
{
    if ((count != 1 && count != 3) || lights < 2 || lights == count || (count == 1 && lights == 3)) return false;
    for (size_t i = 0; i < count; i++)
        if (row[i]->count != lights || count_numbers(row[i]) != lights) return false;
    return true;
}

static status take_columns(const char *path, const text_row *const *row, size_t count, const light_strengths *of)
{
    status s = OK;
    for (size_t i = 0; i < of->count; i++)
        for (size_t k = 0; k < 3 && s == OK; k++) {
            const text_row *r = row[count == 3 ? k : 0];
            s = take_value(path, r->line, &r->word[i], &of->value[i][k]);
        }
    return s;
}

/* ---- the whole ---- */

/* Lists the rows without comments, and without words before the first number. */
static status list_rows(const text_rows *rows, const text_row ***out, size_t *count)
{
    *count = 0;
    *out = calloc(rows->count + 1, sizeof **out);
    if (!*out) return fail(MERLIN_NO_MEMORY, "no memory for %zu lines", rows->count);
    for (size_t i = 0; i < rows->count; i++) {
        const text_row *r = &rows->row[i];
        if (r->comment || (*count == 0 && count_numbers(r) == 0)) continue;
        (*out)[(*count)++] = r;
    }
    return OK;
}

static status take_rows(const char *path, const text_rows *rows, const light_strengths *of)
{
    const text_row **row;
    size_t count;
    status s = list_rows(rows, &row, &count);
    if (s == OK && are_columns(row, count, of->count)) {
        s = take_columns(path, row, count, of);
    } else if (s == OK) {
        for (size_t i = 0; i < count && s == OK; i++)
            s = take_row(path, row[i], i < of->count ? i : of->count, of);
        if (s == OK && count != of->count)
            s = fail(MERLIN_BAD_INPUT, "%s has %zu intensit%s for %zu light%s", path, count, count == 1 ? "y" : "ies",
                     of->count, of->count == 1 ? "" : "s");
    }
    free(row);
    return s;
}

status light_strengths_read(const char *path, const light_strengths *of)
{
    char *text;
    size_t size;
    text_rows rows;
    status s = file_read(path, TEXT_MOST, &text, &size);
    if (s != OK) return s;
    s = text_rows_parse(text, size, path, &rows);
    free(text);
    if (s == OK) {
        s = take_rows(path, &rows, of);
        text_rows_free(&rows);
    }
    return s;
}

static status refuse_two(const char *one, const char *other)
{
    return fail(MERLIN_BAD_INPUT, "%s and %s both say how strong the lights are; remove one", one, other);
}

/* Finds a folder's file of intensities; fails if *path is set already, as both would state the same lights. */
static status find_in(const char *folder, char **path)
{
    static const char *const bases[] = {"light_intensities", "light_intensity", "intensities"};
    static const char *const endings[] = {"txt", "csv", "tsv", "dat"};
    status s = OK;
    for (size_t i = 0; i < sizeof bases / sizeof *bases; i++)
        for (size_t k = 0; k < sizeof endings / sizeof *endings && s == OK; k++) {
            char name[32], *found;
            snprintf(name, sizeof name, "%s.%s", bases[i], endings[k]);
            s = file_find_named(folder, (const char *const[]){name, NULL}, &found);
            if (s != OK || !found) continue;
            if (*path)
                s = refuse_two(*path, found);
            else
                *path = found;
            if (s != OK) free(found);
        }
    return s;
}

status light_strengths_find(const char *folder, const char *lights, bool listed, char **path)
{
    char *beside = lights ? file_folder_of(lights) : NULL;
    status s = lights && !beside ? fail(MERLIN_NO_MEMORY, "no memory for a file name") : OK;
    *path = NULL;
    if (s == OK) s = find_in(folder, path);
    if (s == OK && beside && !file_is_same(folder, beside)) s = find_in(beside, path);
    free(beside);
    if (s == OK && listed && *path) s = refuse_two(lights, *path);
    if (s == OK) return OK;
    free(*path);
    *path = NULL;
    return s;
}
