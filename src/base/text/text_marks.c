/* SPDX-License-Identifier: MIT */
#include "base/text/text_marks.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

enum { DEEPEST = 64, ROW_NUMBERS = 3, LONGEST_QUOTATION = 1024 };

static const char *line_end(const char *at, const char *end)
{
    const char *stop = memchr(at, '\n', (size_t)(end - at));
    return stop ? stop : end;
}

/* ---- comments and quotations ---- */

static bool stands_between(char c)
{
    return text_is_blank(c) || strchr(",;:=()[]{}", c);
}

/* Returns the character that ends the quotation which begins at `at`; NULL if none begins there: an apostrophe inside a
 * name does not begin one. Inside, two double quotes stand for one. */
static const char *quotation_end(const char *line, const char *at, const char *stop)
{
    if ((*at != '"' && *at != '\'') || (at > line && !stands_between(at[-1]))) return NULL;
    for (const char *c = at + 1; c < stop && c - at <= LONGEST_QUOTATION; c++) {
        if (*c != *at) continue;
        if (c + 1 < stop && c[1] == *at && *at == '"') {
            c++;
            continue;
        }
        if (c + 1 == stop || stands_between(c[1])) return c;
    }
    return NULL;
}

/* Tells whether a comment begins here: inside a name these characters do not begin one, and a spreadsheet's line that
 * begins with semicolons is just empty. */
static bool begins_comment(const char *first, const char *at, const char *stop)
{
    if (at > first && at[-1] != ' ' && at[-1] != '\t') return false;
    if (*at == '#' || *at == '%') return true;
    if (*at == ';') return at == first;
    return *at == '/' && at + 1 < stop && at[1] == '/';
}

static void mark_line(const char *line, const char *stop, unsigned char *marks)
{
    const char *first = line;
    while (first < stop && text_is_blank(*first))
        first++;
    for (const char *at = first; at < stop; at++) {
        const char *end = quotation_end(line, at, stop);
        if (end) {
            marks[at - line] = marks[end - line] = MARK_QUOTE;
            memset(marks + (at - line) + 1, MARK_QUOTED, (size_t)(end - at) - 1);
            at = end;
        } else if (begins_comment(first, at, stop)) {
            memset(marks + (at - line), MARK_COMMENT, (size_t)(stop - at));
            return;
        }
    }
}

/* ---- brackets ---- */

typedef struct bracket {
    size_t at;
    bool around; /* contains other brackets */
} bracket;

typedef struct brackets {
    const char *text;
    unsigned char *marks;
    size_t size;
    bracket open[DEEPEST];
    int depth;
} brackets;

/* Tells whether a bracket is punctuation, instead of part of a name such as "IMG (2).jpg". */
static bool stands_alone(const brackets *b, size_t open, size_t close)
{
    char before = open > 0 ? b->text[open - 1] : ' ', after = close + 1 < b->size ? b->text[close + 1] : ' ';
    return (text_is_blank(before) || strchr(",;=:([{", before)) && (text_is_blank(after) || strchr(",;:)]}", after));
}

static bool begins_number(const char *c)
{
    c += *c == '+' || *c == '-';
    c += *c == '.';
    return isdigit((unsigned char)*c) || strncasecmp(c, "nan", 3) == 0 || strncasecmp(c, "inf", 3) == 0;
}

static bool holds_numbers(const brackets *b, size_t from, size_t to)
{
    int count = 0;
    for (size_t i = from; i < to && count < ROW_NUMBERS; i++) {
        bool begins = text_is_blank(b->text[i - 1]) || strchr(",;([{", b->text[i - 1]);
        count += begins && b->marks[i] != MARK_COMMENT && begins_number(b->text + i);
    }
    return count == ROW_NUMBERS;
}

static void close_bracket(brackets *b, size_t at)
{
    static const char opens[] = "([{", closes[] = ")]}";
    if (b->depth == 0 || b->text[b->open[b->depth - 1].at] != opens[strchr(closes, b->text[at]) - closes]) return;
    bracket open = b->open[--b->depth];
    if (!stands_alone(b, open.at, at) || !(open.around || holds_numbers(b, open.at + 1, at))) return;
    b->marks[open.at] = open.around ? MARK_OPEN : MARK_OPEN_ROW;
    b->marks[at] = open.around ? MARK_CLOSE : MARK_CLOSE_ROW;
    for (int i = 0; i < b->depth; i++)
        b->open[i].around = true;
}

/* Opens a bracket. One in a name may never be closed, so that the oldest open one is dropped when there is no room. */
static void open_bracket(brackets *b, size_t at)
{
    if (b->depth == DEEPEST) memmove(b->open, b->open + 1, (size_t)--b->depth * sizeof *b->open);
    b->open[b->depth++] = (bracket){at, false};
}

static void mark_brackets(brackets *b)
{
    for (size_t i = 0; i < b->size; i++) {
        if (b->marks[i] != MARK_NONE) continue;
        if (strchr("([{", b->text[i])) open_bracket(b, i);
        if (strchr(")]}", b->text[i])) close_bracket(b, i);
    }
}

void text_mark_all(const char *text, size_t size, unsigned char *marks)
{
    for (const char *line = text, *end = text + size; line < end;) {
        const char *stop = line_end(line, end);
        mark_line(line, stop, marks + (line - text));
        line = stop + (stop < end);
    }
    mark_brackets(&(brackets){.text = text, .marks = marks, .size = size});
}
