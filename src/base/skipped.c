/* SPDX-License-Identifier: MIT */
#include "base/skipped.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/json/json_put.h"

/* bytes reserved behind the names for ", ... and 1234567 more" */
enum { ROOM_FOR_MORE = 32 };

static status make_room(skipped_files *list, size_t more)
{
    skipped_file *larger = realloc(list->at, (list->count + more) * sizeof *larger);
    if (!larger) return fail(MERLIN_NO_MEMORY, "no memory for file names");
    list->at = larger;
    return OK;
}

status skipped_add(skipped_files *list, const char *name, const char *why)
{
    status s = make_room(list, 1);
    if (s != OK) return s;
    skipped_file one = {strdup(name), strdup(why)};
    if (one.name && one.why) {
        list->at[list->count++] = one;
        return OK;
    }
    free(one.name);
    free(one.why);
    return fail(MERLIN_NO_MEMORY, "no memory for file names");
}

status skipped_append(skipped_files *list, skipped_files *more)
{
    if (more->count == 0) return OK;
    status s = make_room(list, more->count);
    if (s != OK) return s;
    memcpy(list->at + list->count, more->at, more->count * sizeof *more->at);
    list->count += more->count;
    free(more->at);
    *more = (skipped_files){0};
    return OK;
}

static bool is_told(const skipped_files *list, size_t i)
{
    for (size_t k = 0; k < i; k++)
        if (strcmp(list->at[k].why, list->at[i].why) == 0) return true;
    return false;
}

typedef struct sentence {
    char *words;
    size_t at, size; /* size: without the reserved bytes */
    size_t names;
} sentence;

/* Adds a name, preceded by `end`, which closes the reason of the names before it. */
static bool say_name(sentence *s, const char *name, const char *end)
{
    if (s->at + strlen(name) + strlen(end) + 2 >= s->size) return false;
    s->at += (size_t)snprintf(s->words + s->at, s->size - s->at, "%s%s%s", end, s->names ? ", " : "", name);
    s->names++;
    return true;
}

/* Adds the names that share a reason, followed by the reason in brackets. */
static bool say_reason(const skipped_files *list, size_t first, sentence *s)
{
    const char *why = list->at[first].why;
    size_t whole = s->size;
    s->size -= strlen(why) + 3 < s->size ? strlen(why) + 3 : s->size;
    bool all = true;
    size_t before = s->names;
    for (size_t i = first; i < list->count && all; i++)
        if (strcmp(list->at[i].why, why) == 0) all = say_name(s, list->at[i].name, "");
    s->size = whole;
    if (s->names > before) s->at += (size_t)snprintf(s->words + s->at, s->size - s->at, " (%s)", why);
    return all;
}

void skipped_words(const skipped_files *list, char *words, size_t size)
{
    *words = 0;
    if (list->count == 0 || size <= 2 * ROOM_FOR_MORE) return;
    sentence s = {.words = words, .size = size - ROOM_FOR_MORE};
    s.at = (size_t)snprintf(words, size, "%zu file%s skipped: ", list->count, list->count == 1 ? "" : "s");
    bool all = true;
    for (size_t i = 0; i < list->count && all; i++)
        if (!is_told(list, i)) all = say_reason(list, i, &s);
    if (s.names < list->count)
        snprintf(words + s.at, size - s.at, "%s%zu more", s.names ? " and " : "", list->count - s.names);
}

void skipped_warn(const skipped_files *list, warnings *out)
{
    char words[WARNING_WORDS];
    skipped_words(list, words, sizeof words);
    if (*words) warnings_add(out, "files_skipped", "%s", words);
}

void skipped_print(const skipped_files *list, const char *command, const char *folder)
{
    warnings one = {0};
    skipped_warn(list, &one);
    warnings_print(&one, command, folder, 1);
}

void skipped_json(const skipped_files *list, const char *folder, cJSON *array)
{
    for (size_t i = 0; i < list->count; i++) {
        cJSON *one = json_append_object(array);
        char *path = file_join(folder, list->at[i].name);
        if (path)
            json_put_text(one, "file", path);
        else
            json_put_item(one, "file", NULL);
        json_put_text(one, "why", list->at[i].why);
        free(path);
    }
}

void skipped_free(skipped_files *list)
{
    for (size_t i = 0; i < list->count; i++) {
        free(list->at[i].name);
        free(list->at[i].why);
    }
    free(list->at);
    *list = (skipped_files){0};
}
