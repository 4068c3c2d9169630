/* SPDX-License-Identifier: MIT */
#include "base/text/text_rows.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "base/text/text.h"
#include "base/text/text_marks.h"

enum { LONGEST_WORD = 1023, FEWEST_WITH_COMMAS = 3 };

typedef struct scanner {
    const char *text, *where;
    unsigned char *marks;
    size_t size;
    size_t begin; /* first character of the row */
    int line;     /* line of that character */
    int depth;    /* number of open brackets */
    bool inside;  /* the innermost bracket encloses a row */
    bool parts;   /* semicolons in it separate rows */
    bool call;    /* "array(" preceded the table: text after its brackets is not part of it */
    text_rows *rows;
    size_t words, word_room, row_room;
} scanner;

/* ---- words ---- */

static status add_word(scanner *s, const text_word *word)
{
    if (s->words == s->word_room) {
        size_t room = s->word_room ? 2 * s->word_room : 256;
        text_word *larger = realloc(s->rows->word, room * sizeof *larger);
        if (!larger) return fail(MERLIN_NO_MEMORY, "no memory for %s", s->where);
        s->rows->word = larger;
        s->word_room = room;
    }
    s->rows->word[s->words++] = *word;
    return OK;
}

static bool parts_words(const scanner *s, size_t i)
{
    unsigned char mark = s->marks[i];
    if (mark == MARK_QUOTED) return false;
    return mark != MARK_NONE || text_is_blank(s->text[i]) || s->text[i] == ';';
}

/* Tells whether there is a dash that begins a list item, as in YAML; before a number it is taken for a minus. */
static bool is_item(const scanner *s, size_t i, size_t end)
{
    if (s->text[i] != '-' || s->marks[i] != MARK_NONE) return false;
    for (i++; i < end && text_is_blank(s->text[i]) && s->marks[i] == MARK_NONE;)
        i++;
    return i < end && s->marks[i] == MARK_OPEN_ROW;
}

/* Splits the characters from i to end into words at spaces, tabs, semicolons, brackets and quotes. */
static status take_words(scanner *s, size_t i, size_t end)
{
    bool apart = true;
    while (i < end && text_is_blank(s->text[i]))
        i++;
    if (i < end && is_item(s, i, end)) i++;
    while (i < end) {
        if (parts_words(s, i)) {
            apart = apart || s->text[i] == ';' || s->text[i] == '\t' || s->marks[i] == MARK_OPEN_ROW;
            i++;
            continue;
        }
        size_t begin = i;
        bool quoted = s->marks[i] == MARK_QUOTED;
        while (i < end && !parts_words(s, i))
            i++;
        text_word w = {.at = s->text + begin, .length = i - begin, .apart = apart};
        if (quoted) w.kind = text_number(w.at, w.length, true, &w.value);
        status result = add_word(s, &w);
        if (result != OK) return result;
        apart = false;
    }
    return OK;
}

/* ---- commas ---- */

static bool is_quoted(const scanner *s, const text_word *w)
{
    return s->marks[w->at - s->text] == MARK_QUOTED;
}

/* Removes commas around a word; a word of commas alone becomes empty. */
static text_word without_commas(const text_word *word)
{
    text_word w = *word;
    while (w.length && w.at[w.length - 1] == ',')
        w.length--;
    while (w.length && *w.at == ',') {
        w.at++;
        w.length--;
    }
    return w;
}

/* Where commas occur in a row's numbers. */
typedef struct comma_places {
    bool inner, outer; /* inner: between digits; outer: after a number */
} comma_places;

/* Tells whether a word is a whole number, or one with a comma between digits. */
static bool may_have_decimal_comma(const scanner *s, const text_word *word, comma_places *has)
{
    if (is_quoted(s, word)) return word->kind == TEXT_NUMBER;
    text_word w = without_commas(word);
    if (!w.length || w.at > word->at || memchr(w.at, '.', w.length)) return false;
    const char *comma = memchr(w.at, ',', w.length);
    if (comma && !(isdigit((unsigned char)comma[-1]) && isdigit((unsigned char)comma[1]))) return false;
    double value;
    if (text_number(w.at, w.length, true, &value) != TEXT_NUMBER) return false;
    has->inner = has->inner || comma;
    has->outer = has->outer || w.length < word->length;
    return true;
}

/* Tells whether a row has decimal commas, as German or French programs write: 0,5 0,25 0,75 or 0,5;0,25;0,75, half as
 * many numbers as if every comma separated words. The numbers are at the row's end or at its beginning. */
static bool has_decimal_commas(const scanner *s, size_t first, bool fields)
{
    comma_places has = {false, false}, ahead = {false, false};
    size_t count = 0, last = s->words;
    const text_word *w = s->rows->word;
    while (last > first && may_have_decimal_comma(s, &w[last - 1], &has)) {
        last--;
        count++;
    }
    if (count == 0) {
        while (first < last && may_have_decimal_comma(s, &w[first], &ahead)) {
            first++;
            count++;
        }
        has = ahead;
    }
    return has.inner && (count >= FEWEST_WITH_COMMAS || (fields && !has.outer));
}

static void keep_commas(scanner *s, size_t first)
{
    size_t kept = first;
    bool apart = false;
    for (size_t i = first; i < s->words; i++) {
        const text_word *whole = &s->rows->word[i];
        text_word w = is_quoted(s, whole) ? *whole : without_commas(whole);
        w.apart = w.apart || apart || w.at > whole->at;
        apart = w.at + w.length < whole->at + whole->length || (apart && w.length == 0);
        if (w.length == 0) continue;
        if (!is_quoted(s, &w)) w.kind = text_number(w.at, w.length, true, &w.value);
        s->rows->word[kept++] = w;
    }
    s->words = kept;
}

/* Splits one word at its commas; *apart: a comma came before it, and afterwards whether one follows. */
static status split(scanner *s, const text_word *from, bool *apart)
{
    status result = OK;
    for (size_t i = 0; i < from->length && result == OK;) {
        if (from->at[i] == ',') {
            *apart = true;
            i++;
            continue;
        }
        size_t begin = i;
        while (i < from->length && from->at[i] != ',')
            i++;
        text_word w = {.at = from->at + begin, .length = i - begin, .apart = *apart || (begin == 0 && from->apart)};
        w.kind = text_number(w.at, w.length, false, &w.value);
        result = add_word(s, &w);
        *apart = false;
    }
    return result;
}

static status split_at_commas(scanner *s, size_t first)
{
    size_t count = s->words - first;
    text_word *whole = malloc(count * sizeof *whole);
    if (!whole) return fail(MERLIN_NO_MEMORY, "no memory for %s", s->where);
    memcpy(whole, s->rows->word + first, count * sizeof *whole);
    s->words = first;
    bool apart = false;
    status result = OK;
    for (size_t i = 0; i < count && result == OK; i++) {
        if (!is_quoted(s, &whole[i])) {
            result = split(s, &whole[i], &apart);
            continue;
        }
        whole[i].apart = whole[i].apart || apart;
        apart = false;
        result = add_word(s, &whole[i]);
    }
    free(whole);
    return result;
}

/* ---- rows ---- */

/* Removes trailing ':' and '=' of names such as "Light 1:" and "L =". */
static void strip_signs(scanner *s, size_t first)
{
    size_t kept = first;
    bool apart = false;
    for (size_t i = first; i < s->words; i++) {
        text_word w = s->rows->word[i];
        w.apart = w.apart || apart;
        apart = false;
        while (!is_quoted(s, &w) && w.length && strchr(":=", w.at[w.length - 1])) {
            w.length--;
            apart = true;
        }
        if (w.length == 0) continue;
        if (apart) w.kind = text_number(w.at, w.length, false, &w.value);
        s->rows->word[kept++] = w;
    }
    s->words = kept;
}

/* Tells whether commas separate some of the row's numbers and only spaces others. */
static bool is_mixed(const text_word *w, size_t count)
{
    bool commas = false, blanks = false;
    for (size_t i = 1; i < count; i++) {
        if (w[i].kind == TEXT_WORD || w[i - 1].kind == TEXT_WORD) continue;
        const char *behind = w[i - 1].at + w[i - 1].length;
        bool comma = memchr(behind, ',', (size_t)(w[i].at - behind));
        commas = commas || comma;
        blanks = blanks || !comma;
    }
    return commas && blanks;
}

static int lines_between(const char *at, const char *end)
{
    int count = 0;
    while ((at = memchr(at, '\n', (size_t)(end - at)))) {
        at++;
        count++;
    }
    return count;
}

static status check_lengths(const scanner *s, size_t first)
{
    for (size_t i = first; i < s->words; i++)
        if (s->rows->word[i].length > LONGEST_WORD)
            return fail(MERLIN_BAD_INPUT, "%s:%d: a word of %zu bytes is too long", s->where,
                        s->line + lines_between(s->text + s->begin, s->rows->word[i].at), s->rows->word[i].length);
    return OK;
}

static status add_row(scanner *s, size_t first, bool comment, bool mixed)
{
    const char *begin = s->text + s->begin;
    text_rows *rows = s->rows;
    if (rows->count == s->row_room) {
        size_t room = s->row_room ? 2 * s->row_room : 64;
        text_row *larger = realloc(rows->row, room * sizeof *larger);
        if (!larger) return fail(MERLIN_NO_MEMORY, "no memory for %s", s->where);
        rows->row = larger;
        s->row_room = room;
    }
    rows->row[rows->count++] = (text_row){.count = s->words - first,
                                          .line = s->line + lines_between(begin, s->rows->word[first].at),
                                          .comment = comment,
                                          .mixed = mixed};
    return OK;
}

/* Adds the characters from s->begin to end as a row, unless they contain no word. */
static status take_row(scanner *s, size_t end, bool comment)
{
    size_t first = s->words;
    status result = take_words(s, s->begin, end);
    if (result != OK || s->words == first) return result;
    bool fields = false;
    for (size_t i = s->begin; i < end; i++)
        fields = fields || (s->marks[i] == MARK_NONE && (s->text[i] == ';' || s->text[i] == '\t'));
    bool decimal = has_decimal_commas(s, first, fields);
    if (decimal)
        keep_commas(s, first);
    else
        result = split_at_commas(s, first);
    if (result == OK) strip_signs(s, first);
    if (result == OK && !comment) result = check_lengths(s, first);
    if (result != OK || s->words == first) return result;
    return add_row(s, first, comment, !decimal && is_mixed(s->rows->word + first, s->words - first));
}

/* Ends the current row before `end`, where the next one begins. */
static status end_row(scanner *s, size_t end)
{
    status result = s->call && s->depth == 0 ? OK : take_row(s, end, false);
    s->line += lines_between(s->text + s->begin, s->text + end);
    s->begin = end;
    return result;
}

/* Adds a comment that fills the whole line as a row of its own. */
static status take_comment(scanner *s, size_t end)
{
    size_t first = end;
    while (first > 0 && s->text[first - 1] != '\n')
        first--;
    while (first < end && text_is_blank(s->text[first]))
        first++;
    if (first == end || s->marks[first] != MARK_COMMENT) return OK;
    while (first < end && strchr("#%/;", s->text[first]))
        first++;
    memset(s->marks + first, MARK_NONE, end - first);
    s->begin = first; /* still the same line */
    status result = take_row(s, end, true);
    s->begin = end;
    return result;
}

/* ---- the ends of rows ---- */

/* Tells whether semicolons separate rows: they do in [0 0 1; 0 1 0], not in (0,5; 0; 0,8). */
static bool semicolons_part_rows(const scanner *s, size_t open)
{
    int commas = 0, words = 0;
    for (size_t i = open + 1; i < s->size && s->text[i] != ';' && s->marks[i] != MARK_CLOSE_ROW; i++) {
        bool blank = text_is_blank(s->text[i]);
        commas += s->text[i] == ',';
        words += !blank && (i == open + 1 || text_is_blank(s->text[i - 1]));
    }
    return commas > 1 || words > 1;
}

static bool is_open(unsigned char mark)
{
    return mark == MARK_OPEN || mark == MARK_OPEN_ROW;
}

static bool opens_again(const scanner *s, size_t i)
{
    while (++i < s->size && s->text[i] != '\n')
        if (is_open(s->marks[i])) return true;
    return false;
}

/* Opens a bracket; skips the table's name before "= [[" or "array([[". */
static void open_bracket(scanner *s, size_t i)
{
    size_t before = i;
    while (s->depth == 0 && before > s->begin && text_is_blank(s->text[before - 1]))
        before--;
    char sign = before > s->begin && s->depth == 0 ? s->text[before - 1] : 0;
    if (sign == '(' || sign == '=') {
        s->line += lines_between(s->text + s->begin, s->text + i);
        s->begin = i;
        s->call = sign == '(';
    }
    s->depth++;
    s->inside = s->marks[i] == MARK_OPEN_ROW;
    s->parts = s->inside && semicolons_part_rows(s, i);
}

/* Closes a bracket; a name may follow the brackets of a row that is not enclosed by others. */
static status close_bracket(scanner *s, size_t i)
{
    status result = OK;
    if (s->inside && (s->depth > 1 || s->call || opens_again(s, i))) result = end_row(s, i + 1);
    s->depth--;
    s->inside = false;
    return result;
}

static status end_line(scanner *s, size_t i)
{
    if (s->depth > 1 || (s->depth == 1 && !s->inside)) return OK;
    status result = end_row(s, i);
    if (result == OK && s->depth == 0) result = take_comment(s, i);
    s->call = s->call && s->depth > 0;
    return result;
}

static status scan(scanner *s)
{
    status result = OK;
    for (size_t i = 0; i < s->size && result == OK; i++) {
        unsigned char mark = s->marks[i];
        if (is_open(mark))
            open_bracket(s, i);
        else if (mark == MARK_CLOSE || mark == MARK_CLOSE_ROW)
            result = close_bracket(s, i);
        else if (s->text[i] == '\n')
            result = end_line(s, i);
        else if (s->text[i] == ';' && mark == MARK_NONE && s->inside && s->parts) {
            result = end_row(s, i);
            s->begin = i + 1;
        }
    }
    return result == OK ? end_line(s, s->size) : result;
}

static void find_words(text_rows *rows)
{
    size_t first = 0;
    for (size_t i = 0; i < rows->count; i++) {
        rows->row[i].word = rows->word + first;
        first += rows->row[i].count;
    }
}

status text_rows_parse(const char *bytes, size_t size, const char *where, text_rows *out)
{
    *out = (text_rows){0};
    status s = text_decode(bytes, size, where, &out->text);
    if (s != OK) return s;
    size_t length = strlen(out->text);
    scanner all = {
        .text = out->text, .where = where, .size = length, .line = 1, .rows = out, .marks = calloc(length + 1, 1)};
    s = all.marks ? OK : fail(MERLIN_NO_MEMORY, "no memory for %s", where);
    if (s == OK) {
        text_mark_all(out->text, length, all.marks);
        s = scan(&all);
    }
    free(all.marks);
    find_words(out);
    if (s != OK) text_rows_free(out);
    return s;
}

void text_rows_free(text_rows *rows)
{
    free(rows->row);
    free(rows->word);
    free(rows->text);
    *rows = (text_rows){0};
}
