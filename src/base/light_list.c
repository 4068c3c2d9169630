#include "base/light_list.h"

#include <ctype.h>
#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/plain_locale.h"

enum { LINE_MAX_LENGTH = 1024, FILE_MAX_SIZE = 1 << 22 };
static const float LARGEST = 1e6f; /* a kilometre of millimetres, squared well within a float */

typedef struct reader {
    const char *text, *end, *where;
    int line;
    bool lp;        /* the first line held a count */
    long announced; /* that count */
} reader;

void light_list_free(light_list *list)
{
    for (size_t i = 0; list->name && i < list->count; i++)
        free(list->name[i]);
    free(list->name);
    free(list->length);
    free(list->at);
    *list = (light_list){0};
}

status light_list_add(light_list *list, vec3 light)
{
    if (list->count >= LIGHT_LIST_MAX) return fail(ERROR_INPUT, "more than %d lights", LIGHT_LIST_MAX);
    vec3 *larger = realloc(list->at, (list->count + 1) * sizeof *larger);
    if (!larger) return fail(ERROR_MEMORY, "no memory for %zu lights", list->count + 1);
    larger[list->count++] = light;
    list->at = larger;
    return OK;
}

/* The name of the light that was added last, and its direction's length. */
static status add_name(light_list *list, const char *word, real length)
{
    real *longer = realloc(list->length, list->count * sizeof *longer);
    if (longer) {
        list->length = longer;
        list->length[list->count - 1] = length;
    }
    char **larger = longer ? realloc(list->name, list->count * sizeof *larger) : NULL;
    if (larger) {
        list->name = larger;
        list->name[list->count - 1] = strdup(word);
    }
    if (larger && list->name[list->count - 1]) return OK;
    list->count--;
    return fail(ERROR_MEMORY, "no memory for %zu lights", list->count + 1);
}

/* The next line without its comment and outer blanks into line; false at the end of the text. */
static status next_line(reader *r, char line[LINE_MAX_LENGTH], bool *found)
{
    *found = r->text < r->end;
    if (!*found) return OK;
    r->line++;
    const char *stop = memchr(r->text, '\n', (size_t)(r->end - r->text));
    const char *begin = r->text, *end = stop ? stop : r->end;
    r->text = stop ? stop + 1 : r->end;
    if (memchr(begin, 0, (size_t)(end - begin))) return fail(ERROR_INPUT, "%s:%d: not a text file", r->where, r->line);
    for (const char *c = begin; c < end; c++) /* in a name it is no comment */
        if (*c == '#' && (c == begin || strchr(" \t", c[-1]))) end = c;
    while (begin < end && strchr(" \t\r\v\f", *begin))
        begin++;
    while (begin < end && strchr(" \t\r\v\f", end[-1]))
        end--;
    if (end - begin >= LINE_MAX_LENGTH) return fail(ERROR_INPUT, "%s:%d: the line is too long", r->where, r->line);
    memcpy(line, begin, (size_t)(end - begin));
    line[end - begin] = 0;
    return OK;
}

/* Whole-word finite number. */
static bool word_number(const char *word, float *out)
{
    char *end;
    errno = 0;
    *out = strtof_l(word, &end, plain_locale());
    return end != word && *end == 0 && isfinite(*out);
}

/* Where the last of the words that blanks alone part begins; *end moves to its end. */
static char *last_word_between_blanks(const char *line, char **end)
{
    while (*end > line && strchr(" \t", (*end)[-1]))
        --*end;
    char *begin = *end;
    while (begin > line && !strchr(" \t", begin[-1]))
        begin--;
    return begin;
}

/* A number, and in it at most one comma, between digits; *comma is NULL if there is none. */
static bool may_have_decimal_comma(char *word, const char *end, char **comma)
{
    size_t length = (size_t)(end - word);
    *comma = memchr(word, ',', length);
    if (!length || strspn(word, "+-0123456789,eE") < length) return false;
    if (!*comma) return true;
    return *comma > word && isdigit((unsigned char)(*comma)[-1]) && isdigit((unsigned char)(*comma)[1]) &&
           !memchr(*comma + 1, ',', (size_t)(end - *comma) - 1);
}

/* Programs that speak German or French write 0,5 0,25 0,75: six numbers, if every comma parted words. */
static void replace_decimal_commas(const reader *r, char *line)
{
    char *comma[3], *end = line + strlen(line), *word = line;
    for (int i = 0; i < 3; i++, end = word) {
        word = last_word_between_blanks(line, &end);
        if (!may_have_decimal_comma(word, end, &comma[i])) return;
    }
    if (r->lp == (word == line)) return; /* a name stands before, or nothing does */
    for (int i = 0; i < 3; i++)
        if (comma[i]) *comma[i] = '.';
}

static bool is_between_words(char c)
{
    return c && strchr(" \t\r\v\f,", c);
}

static int count_words(const char *line)
{
    int count = 0;
    for (const char *c = line; *c; c++)
        count += !is_between_words(*c) && (c == line || is_between_words(c[-1]));
    return count;
}

static char *without_blanks_behind(char *line)
{
    char *end = line + strlen(line);
    while (end > line && is_between_words(end[-1]))
        end--;
    *end = 0;
    return end;
}

/* Cuts the last word off, which must be there. */
static char *take_last_word(char *line)
{
    char *word = without_blanks_behind(line);
    while (word > line && !is_between_words(word[-1]))
        word--;
    if (word > line) word[-1] = 0;
    return word;
}

static status direction_to_position(const reader *r, vec3 *v, real *length)
{
    *length = vec3_length(*v);
    if (!(*length > (real)1e-6)) return fail(ERROR_INPUT, "%s:%d: the direction has no length", r->where, r->line);
    *v = vec3_add(vec3_scale(*v, 1 / *length), vec3_make(0, 0, -1));
    return OK;
}

/* Cuts the numbers off: of an .lp file's line the name is left, which may have blanks in it. */
static status parse_light(const reader *r, char *line, vec3 *out, real *length)
{
    replace_decimal_commas(r, line);
    int count = count_words(line);
    if (r->lp ? count < 4 : count != 3)
        return fail(ERROR_INPUT, "%s:%d: expected %s, found %d word%s", r->where, r->line,
                    r->lp ? "a name and x y z" : "x y z", count, count == 1 ? "" : "s");
    const char *words[3];
    float v[3];
    for (int i = 2; i >= 0; i--)
        words[i] = take_last_word(line);
    for (int i = 0; i < 3; i++) {
        if (!word_number(words[i], &v[i]))
            return fail(ERROR_INPUT, "%s:%d: \"%.40s\" is not a finite number", r->where, r->line, words[i]);
        if (fabsf(v[i]) > LARGEST)
            return fail(ERROR_INPUT, "%s:%d: %.40s is out of range (±%g)", r->where, r->line, words[i],
                        (double)LARGEST);
    }
    *out = vec3_of(v);
    return r->lp ? direction_to_position(r, out, length) : OK;
}

/* A first line that holds one whole number is the count of an .lp file. */
static status parse_count(reader *r, const char *word)
{
    char *end;
    errno = 0;
    long value = strtol(word, &end, 10);
    if (end == word || *end || errno || value < 1)
        return fail(ERROR_INPUT, "%s:%d: expected x y z or a count of lights, found \"%.40s\"", r->where, r->line,
                    word);
    if (value > LIGHT_LIST_MAX)
        return fail(ERROR_INPUT, "%s:%d: %ld lights are more than %d", r->where, r->line, value, LIGHT_LIST_MAX);
    r->lp = true;
    r->announced = value;
    return OK;
}

static status parse_line(reader *r, char *line, bool first, light_list *out)
{
    if (first && count_words(line) == 1) return parse_count(r, line);
    vec3 light;
    real length = 0;
    status s = parse_light(r, line, &light, &length);
    if (s != OK) return s;
    s = light_list_add(out, light);
    without_blanks_behind(line);
    if (s == OK && r->lp) s = add_name(out, line, length);
    return s == OK ? OK : fail_in(s, "%s:%d", r->where, r->line);
}

static status parse_lines(reader *r, light_list *out)
{
    char line[LINE_MAX_LENGTH];
    bool found, first = true;
    status s = next_line(r, line, &found);
    for (; s == OK && found; s = next_line(r, line, &found)) {
        if (!line[0]) continue;
        if ((s = parse_line(r, line, first, out)) != OK) break;
        first = false;
    }
    if (s != OK) return s;
    if (r->lp && (size_t)r->announced != out->count)
        return fail(ERROR_INPUT, "%s: the first line says %ld lights, but there are %zu", r->where, r->announced,
                    out->count);
    return out->count ? OK : fail(ERROR_INPUT, "%s: no lights in it (one x y z a line)", r->where);
}

status light_list_parse(const char *text, size_t size, const char *where, light_list *out)
{
    *out = (light_list){0};
    reader r = {.text = text + file_text_mark(text, size), .end = text + size, .where = where};
    status s = parse_lines(&r, out);
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
