/* SPDX-License-Identifier: MIT */
#include "stereo/capture/match_lights.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "stereo/capture/capture_parts.h"

enum { NAMED = 3, NAMES = 400 };

/* The files of a folder, and those that are a capture's pictures, in order. */
typedef struct listing {
    const char *folder;
    const merlin_capture_files *options;
    char **paths;
    size_t count;
    merlin_capture pictures;
} listing;

static status list_all(const char *folder, const merlin_capture_files *options, listing *out)
{
    *out = (listing){.folder = folder, .options = options};
    status s = file_list(folder, NULL, &out->paths, &out->count);
    return s == OK ? pst_take_pictures(folder, false, options, NULL, 0, &out->pictures) : s;
}

static void free_listing(listing *in)
{
    file_list_free(in->paths, in->count);
    pst_capture_free(&in->pictures);
}

/* ---- names ---- */

/* Returns the file name from a path that may come from another machine. */
static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/'), *backslash = strrchr(path, '\\');
    const char *last = slash > backslash ? slash : backslash;
    return last ? last + 1 : path;
}

/* Tells whether a name ends with a dot and letters, and not with the numbers of columns that are unknown here. */
static bool ends_as_a_file(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && dot > name && isalpha((unsigned char)dot[1]) && !strpbrk(dot, " \t,");
}

static size_t stem_length(const char *name)
{
    return ends_as_a_file(name) ? (size_t)(strrchr(name, '.') - name) : strlen(name);
}

static bool have_one_stem(const char *one, const char *other)
{
    size_t length = stem_length(one);
    return length == stem_length(other) && strncasecmp(one, other, length) == 0;
}

/* Returns the folder's file of that name, in any case, as lists from Windows may have it; else its picture with another
 * ending, or with one. NULL if there is not exactly one. */
static const char *find_file(const listing *in, const char *name)
{
    const char *found = NULL;
    size_t alike = 0;
    for (size_t i = 0; i < in->count; i++) {
        const char *file = base_name(in->paths[i]);
        if (strcmp(file, name) == 0) return file;
        if (strcasecmp(file, name) != 0) continue;
        found = file;
        alike++;
    }
    for (int i = 0; alike == 0 && !found && i < in->pictures.count; i++) {
        if (!have_one_stem(in->pictures.name[i], name)) continue;
        for (int k = i; k < in->pictures.count; k++)
            alike += have_one_stem(in->pictures.name[k], name);
        found = in->pictures.name[i];
    }
    return alike == 1 ? found : NULL;
}

/* Finds a listed name, before which there may be a number in a column of its own. */
static const char *find_listed(const listing *in, const char *listed)
{
    const char *name = base_name(listed), *found = find_file(in, name);
    size_t digits = strspn(name, "0123456789"), blanks = digits ? strspn(name + digits, " \t") : 0;
    return found || !blanks ? found : find_file(in, name + digits + blanks);
}

status pst_match_name(const char *folder, const char *name, char **found)
{
    listing in;
    *found = NULL;
    status s = list_all(folder, &(merlin_capture_files){0}, &in);
    const char *file = s == OK ? find_listed(&in, name) : NULL;
    if (file && !(*found = strdup(file))) s = fail(MERLIN_NO_MEMORY, "no memory for a file name");
    free_listing(&in);
    return s;
}

/* ---- numbers ---- */

/* Returns the length of a label without the digits at its end. */
static size_t label_length(const char *label)
{
    size_t length = strlen(label);
    while (length > 0 && isdigit((unsigned char)label[length - 1]))
        length--;
    return length;
}

/* Fills place with each light's picture, counted from 0, if the names are "Light 1", "Light 2" and so on, or only
 * numbers from 0 or 1 in any order. */
static bool are_numbers(const light_list *list, size_t *place, bool *taken)
{
    size_t prefix = label_length(list->name[0]), count = list->count;
    bool zero = false;
    for (size_t i = 0; i < count; i++) {
        const char *name = list->name[i], *digits = name + label_length(name);
        size_t length = strlen(digits);
        if (label_length(name) != prefix || strncasecmp(name, list->name[0], prefix) != 0) return false;
        if (length < 1 || length > 6 || (prefix && strchr(name, '.'))) return false;
        place[i] = (size_t)strtoul(digits, NULL, 10);
        zero = zero || place[i] == 0;
    }
    for (size_t i = 0; i < count; i++) {
        place[i] -= !zero;
        if (place[i] >= count || taken[place[i]]) return false;
        taken[place[i]] = true;
    }
    return true;
}

static bool are_files_in_order(const light_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        if (!ends_as_a_file(list->name[i]) ||
            (i && file_compare_names(base_name(list->name[i - 1]), base_name(list->name[i])) >= 0))
            return false;
    return true;
}

/* ---- the whole ---- */

/* Appends a name to text, if it is one of the first few, or the number of further ones. */
static void put_name(char text[NAMES], size_t count, const char *name)
{
    size_t length = strlen(text);
    if (count < NAMED) snprintf(text + length, NAMES - length, "%s%.80s", count ? ", " : "", name);
}

static void put_more(char text[NAMES], size_t count)
{
    size_t length = strlen(text);
    if (count > NAMED) snprintf(text + length, NAMES - length, " and %zu more", count - NAMED);
}

static size_t count_missing(const listing *in, const light_list *list, char text[NAMES])
{
    size_t count = 0;
    text[0] = 0;
    for (size_t i = 0; i < list->count; i++)
        if (!find_listed(in, list->name[i])) put_name(text, count++, list->name[i]);
    put_more(text, count);
    return count;
}

static status refuse_missing(const listing *in, const char *lights, size_t count, const char *names)
{
    return fail(MERLIN_BAD_INPUT,
                "%s names %s, but %s has no such picture%s, or several; correct the names, or leave all of them out to "
                "take the lights in the order of the pictures' names",
                lights, names, in->folder, count > 1 ? "s" : "");
}

static status check_twice(const char *lights, const light_list *list, const merlin_capture *c)
{
    for (size_t i = 0; i < list->count; i++)
        for (size_t k = 0; k < i; k++)
            if (strcmp(c->name[i], c->name[k]) == 0)
                return fail(MERLIN_BAD_INPUT, "%s:%d: %.80s has a light in line %d already", lights, list->line[i],
                            c->name[i], list->line[k]);
    return OK;
}

/* Notes pictures without a light. A person who removes a line from a list does not want its picture; a file that
 * differs only in its ending from a listed one is the same picture. */
static void note_left_out(const listing *in, const char *lights, merlin_capture *c)
{
    size_t count = 0;
    char text[NAMES] = "";
    for (int i = 0; i < in->pictures.count; i++) {
        bool listed = false;
        for (int k = 0; k < c->count && !listed; k++)
            listed = have_one_stem(in->pictures.name[i], c->name[k]);
        if (!listed) put_name(text, count++, in->pictures.name[i]);
    }
    put_more(text, count);
    if (count)
        warnings_add(&c->noticed, "pictures_without_light", "%s has no light for %s, which %s left out", lights, text,
                     count > 1 ? "were" : "was");
}

static status take_names(const listing *in, const char *lights, const light_list *list, merlin_capture *c)
{
    status s = pst_capture_reserve(c, list->count);
    for (size_t i = 0; i < list->count && s == OK; i++)
        s = pst_capture_set_name(c, i, find_listed(in, list->name[i]));
    if (s == OK) s = check_twice(lights, list, c);
    if (s == OK) note_left_out(in, lights, c);
    return s;
}

static status refuse_count(const listing *in, const char *lights, const light_list *list)
{
    return fail(MERLIN_BAD_INPUT, "%s has %d picture%s, but %s has %zu light%s; each picture needs one", in->folder,
                in->pictures.count, in->pictures.count == 1 ? "" : "s", lights, list->count,
                list->count == 1 ? "" : "s");
}

static status take_numbers(const listing *in, const char *lights, const light_list *list, const size_t *place,
                           merlin_capture *c)
{
    if ((size_t)in->pictures.count != list->count) return refuse_count(in, lights, list);
    status s = pst_capture_reserve(c, list->count);
    for (size_t i = 0; i < list->count && s == OK; i++)
        s = pst_capture_set_name(c, i, in->pictures.name[place[i]]);
    return s;
}

static status take_in_order(const listing *in, const char *lights, const light_list *list, merlin_capture *c)
{
    status s = pst_take_pictures(in->folder, false, in->options, lights, list->count, c);
    c->lights_in_order = true;
    return s == OK ? OK : fail_in(s, "%s names pictures of another folder", lights);
}

static status match(const listing *in, const char *lights, const light_list *list, merlin_capture *c)
{
    char names[NAMES];
    size_t missing = count_missing(in, list, names);
    if (missing == 0) return take_names(in, lights, list, c);
    size_t *place = calloc(list->count, sizeof *place);
    bool *taken = calloc(list->count, sizeof *taken);
    status s = place && taken ? OK : fail(MERLIN_NO_MEMORY, "no memory for %zu lights", list->count);
    if (s == OK && are_numbers(list, place, taken))
        s = take_numbers(in, lights, list, place, c);
    else if (s == OK && missing == list->count && are_files_in_order(list))
        s = take_in_order(in, lights, list, c);
    else if (s == OK)
        s = refuse_missing(in, lights, missing, names);
    free(taken);
    free(place);
    return s;
}

status pst_match_lights(const char *folder, const merlin_capture_files *options, const char *lights,
                        const light_list *list, merlin_capture *c)
{
    if (!list->name) return pst_take_pictures(folder, false, options, lights, list->count, c);
    listing in;
    status s = list_all(folder, options, &in);
    if (s == OK) s = match(&in, lights, list, c);
    free_listing(&in);
    return s;
}
