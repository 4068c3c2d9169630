/* SPDX-License-Identifier: MIT */
/* Columns of a list of lights named by a header line, as spreadsheets and programs write it. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/lights/light_parser.h"

enum { MOST_COLUMNS = 64, LONGEST_NAME = 31 };

typedef enum column {
    UNKNOWN,
    COLUMN_X,
    COLUMN_Y,
    COLUMN_Z,
    COLUMN_RED,
    COLUMN_GREEN,
    COLUMN_BLUE,
    COLUMN_STRENGTH,
    COLUMN_AZIMUTH,
    COLUMN_ELEVATION,
    COLUMN_DISTANCE,
    COLUMN_ANGLE, /* theta, phi and the like, counted from the axis by some programs and from the plane by others */
    COLUMN_INDEX,
    COLUMN_NAME,
    COLUMNS
} column;

/* A field of a row: delimited by commas, tabs or semicolons if the row has any, else one word. */
typedef struct field {
    const text_word *first;
    const char *at;
    size_t length;
} field;

typedef struct header {
    size_t count, place[COLUMNS], known[COLUMNS]; /* known: number of columns of each kind */
    bool degrees, radians;
    field field[MOST_COLUMNS];
    column kind[MOST_COLUMNS];
} header;

static bool has_fields(const text_row *r)
{
    for (size_t i = 1; i < r->count; i++)
        if (r->word[i].apart) return true;
    return false;
}

/* Splits a row into at most MOST_COLUMNS fields; returns how many there are. */
static size_t find_fields(const text_row *r, field *out)
{
    bool fields = has_fields(r);
    size_t count = 0;
    for (size_t i = 0; i < r->count; i++) {
        const text_word *w = &r->word[i];
        if (i == 0 || !fields || w->apart) {
            if (count < MOST_COLUMNS) out[count] = (field){w, w->at, w->length};
            count++;
        } else if (count <= MOST_COLUMNS) {
            out[count - 1].length = (size_t)(w->at + w->length - out[count - 1].at);
        }
    }
    return count;
}

/* ---- names of columns ---- */

static bool is_one_of(const char *word, const char *words)
{
    size_t length = strlen(word);
    for (const char *at = words; *at; at += strcspn(at, " "), at += *at == ' ')
        if (strcspn(at, " ") == length && strncmp(at, word, length) == 0) return true;
    return false;
}

/* Recognizes the name of a coordinate: "x", "lx", "Light X", "dir_y" or "x_pos". */
static column axis_of(const char *word)
{
    static const char before[] = "l d n p v s light dir pos direction position led lightdir lightpos lamp vec normal",
                      behind[] = "dir pos mm cm m direction position coordinate coord axis component";
    size_t length = strlen(word);
    char rest[LONGEST_NAME + 1];
    if (length == 0) return UNKNOWN;
    char last = word[length - 1];
    memcpy(rest, word, length);
    rest[length - 1] = 0;
    if (strchr("xyz", last) && (length == 1 || is_one_of(rest, before))) return (column)(COLUMN_X + (last - 'x'));
    if (strchr("xyz", *word) && is_one_of(word + 1, behind)) return (column)(COLUMN_X + (*word - 'x'));
    return UNKNOWN;
}

static column kind_of(const char *word)
{
    static const struct {
        column kind;
        const char *words;
    } kinds[] = {
        {COLUMN_RED, "r red ir lr intensityr rintensity intensityred"},
        {COLUMN_GREEN, "g green ig lg intensityg gintensity intensitygreen"},
        {COLUMN_BLUE, "b blue ib lb intensityb bintensity intensityblue"},
        {COLUMN_STRENGTH, "intensity intensities strength power brightness"},
        {COLUMN_AZIMUTH, "azimuth az azimuthangle azim"},
        {COLUMN_ELEVATION, "elevation el elev elevationangle altitude alt"},
        {COLUMN_DISTANCE, "distance dist radius"},
        {COLUMN_ANGLE, "theta phi zenith polar inclination colatitude latitude longitude pan tilt angle"},
        {COLUMN_INDEX, "index idx id no nr num number led light lamp n i"},
        {COLUMN_NAME, "name file filename image imagename picture picturename photo img path imagefile imagepath"},
    };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (is_one_of(word, kinds[i].words)) return kinds[i].kind;
    return axis_of(word);
}

/* Classifies a column by its name, in lower case and without anything but letters; a unit, in brackets or after a
 * space, is read separately. */
static column take_field(header *h, const field *f)
{
    char word[LONGEST_NAME + 1], unit[LONGEST_NAME + 1];
    size_t length = 0, units = 0;
    bool in_unit = false;
    for (size_t i = 0; i < f->length; i++) {
        char c = (char)tolower((unsigned char)f->at[i]);
        in_unit = in_unit || strchr("([{", c) != NULL;
        bool degree = c == '\xb0';
        if (degree) h->degrees = true;
        if (!isalpha((unsigned char)c)) continue;
        if (length == LONGEST_NAME || units == LONGEST_NAME) return UNKNOWN;
        if (in_unit)
            unit[units++] = c;
        else
            word[length++] = c;
    }
    word[length] = unit[units] = 0;
    static const char *const endings[] = {"degrees", "degree", "deg", "radians", "radian", "rad"};
    for (size_t i = 0; i < 6; i++) {
        size_t end = strlen(endings[i]);
        bool here = length > end && strcmp(word + length - end, endings[i]) == 0;
        if (!here && strcmp(unit, endings[i]) != 0) continue;
        *(i < 3 ? &h->degrees : &h->radians) = true;
        if (here) word[length -= end] = 0;
    }
    return kind_of(word);
}

static void read_header(const text_row *r, header *h)
{
    *h = (header){0};
    h->count = find_fields(r, h->field);
    for (size_t i = 0; i < h->count && i < MOST_COLUMNS; i++) {
        h->kind[i] = take_field(h, &h->field[i]);
        if (h->known[h->kind[i]]++ == 0) h->place[h->kind[i]] = i;
    }
}

/* ---- rows ---- */

static bool have_its_columns(const light_parser *t, const header *h)
{
    field fields[MOST_COLUMNS];
    for (size_t i = 0; i < t->count; i++)
        if (find_fields(&t->row[i], fields) != h->count) return false;
    return true;
}

/* Returns the field's word, or NULL unless the field is one word. */
static const text_word *number_in(const field *f)
{
    return f->length == f->first->length ? f->first : NULL;
}

static status take_words(const light_parser *t, const header *h, const text_row *r, const column *wanted, size_t count,
                         light_entry *w)
{
    field fields[MOST_COLUMNS];
    find_fields(r, fields);
    w->line = r->line;
    w->count = count;
    for (size_t k = 0; k < count; k++) {
        const field *f = &fields[h->place[wanted[k]]];
        w->number[k] = number_in(f);
        if (!w->number[k] || w->number[k]->kind == TEXT_WORD)
            return fail(MERLIN_BAD_INPUT, "%s:%d: \"%.*s\" is not a finite number", t->where, r->line,
                        (int)(f->length < 40 ? f->length : 40), f->at);
    }
    column named = h->known[COLUMN_NAME] ? COLUMN_NAME : COLUMN_INDEX;
    if (!h->known[named]) return OK;
    w->name = fields[h->place[named]].at;
    w->name_length = fields[h->place[named]].length;
    return OK;
}

/* Turns angles into directions: azimuth from x toward y, elevation from their plane toward the camera. */
static status turn_angles(const light_parser *t, const header *h, bool far, light_list *list)
{
    bool large = false;
    for (size_t i = 0; i < list->count; i++)
        large = large || fabs((double)list->at[i].x) > 2 * M_PI + 1e-3 || fabs((double)list->at[i].y) > M_PI_2 + 1e-3;
    if (h->radians && large)
        return fail(MERLIN_BAD_INPUT, "%s: its header says radians, but it has angles beyond a whole turn", t->where);
    if (!h->radians && !h->degrees)
        return fail(MERLIN_BAD_INPUT, "%s: its header names angles, but no unit; write \"azimuth deg, elevation deg\"",
                    t->where);
    double unit = h->degrees ? M_PI / 180 : 1;
    for (size_t i = 0; i < list->count; i++) {
        vec3 *v = &list->at[i];
        double azimuth = (double)v->x * unit, elevation = (double)v->y * unit, distance = far ? (double)v->z : 1;
        if (!(distance > 0))
            return fail(MERLIN_BAD_INPUT, "%s:%d: the distance is not above zero", t->where, list->line[i]);
        *v = vec3_make((real)(distance * cos(elevation) * cos(azimuth)),
                       (real)(distance * cos(elevation) * sin(azimuth)), (real)(distance * sin(elevation)));
    }
    list->angles = !far;
    return OK;
}

static status add_rows(light_parser *t, const header *h)
{
    bool angles = h->known[COLUMN_X] == 0, far = angles && h->known[COLUMN_DISTANCE];
    column wanted[6] = {COLUMN_X, COLUMN_Y, COLUMN_Z};
    if (angles)
        memcpy(wanted, (const column[]){COLUMN_AZIMUTH, COLUMN_ELEVATION, far ? COLUMN_DISTANCE : COLUMN_AZIMUTH},
               3 * sizeof *wanted);
    size_t count = 3;
    if (h->known[COLUMN_RED] && h->known[COLUMN_GREEN] && h->known[COLUMN_BLUE]) {
        memcpy(wanted + 3, (const column[]){COLUMN_RED, COLUMN_GREEN, COLUMN_BLUE}, 3 * sizeof *wanted);
        count = 6;
    } else if (h->known[COLUMN_STRENGTH] == 1) {
        wanted[3] = COLUMN_STRENGTH;
        count = 4;
    }
    status s = OK;
    for (size_t i = 0; i < t->count && s == OK; i++) {
        light_entry w = {0};
        s = take_words(t, h, &t->row[i], wanted, count, &w);
        if (s == OK) s = light_parser_add(t, &w);
    }
    return s == OK && angles ? turn_angles(t, h, far, t->list) : s;
}

static bool is_used(const header *h, size_t i)
{
    column k = h->kind[i];
    bool colours = h->known[COLUMN_RED] && h->known[COLUMN_GREEN] && h->known[COLUMN_BLUE];
    if (k == UNKNOWN || k == COLUMN_ANGLE || h->place[k] != i) return false;
    if (k == COLUMN_RED || k == COLUMN_GREEN || k == COLUMN_BLUE) return colours;
    if (k == COLUMN_STRENGTH) return !colours && h->known[k] == 1;
    bool angle = k == COLUMN_AZIMUTH || k == COLUMN_ELEVATION || k == COLUMN_DISTANCE;
    return !angle || !h->known[COLUMN_X];
}

static void note_others(light_parser *t, const header *h)
{
    for (size_t i = 0; i < h->count; i++) {
        if (!is_used(h, i))
            light_parser_note(t, "its column \"%.*s\" is not used",
                              (int)(h->field[i].length < 40 ? h->field[i].length : 40), h->field[i].at);
    }
}

/* Tells whether the columns may also be recognized without the header, which is then a title. */
static bool may_be_title(const header *h)
{
    bool angles = h->known[COLUMN_AZIMUTH] || h->known[COLUMN_ELEVATION] || h->known[COLUMN_ANGLE];
    bool axes = h->known[COLUMN_X] == 1 && h->known[COLUMN_Y] == 1 && h->known[COLUMN_Z] == 1;
    size_t x = h->place[COLUMN_X];
    bool in_order = h->place[COLUMN_Y] == x + 1 && h->place[COLUMN_Z] == x + 2;
    return axes ? in_order : !angles;
}

status light_parser_by_header(light_parser *t, bool *done)
{
    header h;
    read_header(t->header, &h);
    bool axes = h.known[COLUMN_X] == 1 && h.known[COLUMN_Y] == 1 && h.known[COLUMN_Z] == 1;
    bool angles = !axes && h.known[COLUMN_AZIMUTH] == 1 && h.known[COLUMN_ELEVATION] == 1;
    bool fits = h.count <= MOST_COLUMNS && (axes || angles) && have_its_columns(t, &h);
    if (fits) {
        *done = true;
        status s = add_rows(t, &h);
        if (s == OK) note_others(t, &h);
        return s;
    }
    if (t->header->comment || h.count > MOST_COLUMNS || may_be_title(&h)) return OK;
    if (axes || angles)
        return fail(MERLIN_BAD_INPUT, "%s:%d: the header has %zu columns, but not all lines have as many", t->where,
                    t->header->line, h.count);
    return fail(
        MERLIN_BAD_INPUT,
        "%s:%d: angles of the names in this header are counted in several ways; name them azimuth (from x toward "
        "y) and elevation (from the picture's plane), with \"deg\", or list x y z",
        t->where, t->header->line);
}
