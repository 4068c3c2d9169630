#include "stereo/text_numbers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/plain_locale.h"

enum { LINE_MOST = 1024 };

static status copy_line(text_numbers *t, char line[LINE_MOST])
{
    const char *stop = memchr(t->text, '\n', (size_t)(t->end - t->text)), *begin = t->text;
    size_t length = (size_t)((stop ? stop : t->end) - begin);
    t->text = stop ? stop + 1 : t->end;
    t->line++;
    if (memchr(begin, 0, length)) return fail(ERROR_INPUT, "%s:%d: not a text file", t->where, t->line);
    if (length >= LINE_MOST) return fail(ERROR_INPUT, "%s:%d: the line is too long", t->where, t->line);
    memcpy(line, begin, length);
    line[length] = 0;
    return OK;
}

static bool is_number(const char *word, double *value)
{
    char *end;
    *value = strtod_l(word, &end, plain_locale());
    return end != word && *end == 0;
}

static status read_values(text_numbers *t, char *line, bool *empty)
{
    char *rest = NULL;
    t->count = 0;
    *empty = true;
    for (char *w = strtok_r(line, " \t\r\v\f,", &rest); w; w = strtok_r(NULL, " \t\r\v\f,", &rest)) {
        double value;
        bool first = *empty, number = is_number(w, &value);
        *empty = false;
        if (first && !number) return OK;
        if (!number || !isfinite(value))
            return fail(ERROR_INPUT, "%s:%d: \"%.40s\" is not a finite number", t->where, t->line, w);
        if (t->count == TEXT_NUMBERS_MOST)
            return fail(ERROR_INPUT, "%s:%d: more than %d numbers on a line", t->where, t->line, TEXT_NUMBERS_MOST);
        t->value[t->count++] = value;
    }
    return OK;
}

status text_numbers_next(text_numbers *t, bool *found)
{
    *found = false;
    while (t->text < t->end) {
        char line[LINE_MOST];
        bool empty;
        status s = copy_line(t, line);
        if (s == OK) s = read_values(t, line, &empty);
        if (s != OK) return s;
        if (empty) continue;
        *found = true;
        return OK;
    }
    return OK;
}
