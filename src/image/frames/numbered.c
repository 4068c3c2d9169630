/* SPDX-License-Identifier: MIT */
#include "image/frames/numbered.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "image/read/folder.h"
#include "merlin/photos.h"

/* Most digits of a number; more are a date or a serial number with one. */
enum { MOST_DIGITS = 15 };

static status no_memory(void)
{
    return fail(MERLIN_NO_MEMORY, "no memory for file names");
}

void numbered_free(numbered_files *files)
{
    for (size_t i = 0; i < files->count; i++) {
        free(files->at[i].path);
        free(files->at[i].mask);
    }
    free(files->at);
    *files = (numbered_files){0};
}

static status add(numbered_files *files, const char *path, long number)
{
    numbered_file *larger = realloc(files->at, (files->count + 1) * sizeof *larger);
    if (!larger) return no_memory();
    files->at = larger;
    larger[files->count] = (numbered_file){.number = number, .path = strdup(path)};
    return larger[files->count++].path ? OK : no_memory();
}

/* ---- numbers in names ---- */

/* A name's parts: before the number, its digits, and behind. */
typedef struct parts {
    size_t before, digits;
    long number;
} parts;

/* Finds the last number of a name without its ending; false if there is none. */
static bool take_apart(const char *name, parts *out)
{
    const char *dot = strrchr(name, '.');
    size_t end = dot && dot != name ? (size_t)(dot - name) : strlen(name);
    while (end > 0 && !isdigit((unsigned char)name[end - 1]))
        end--;
    size_t begin = end;
    while (begin > 0 && end - begin < MOST_DIGITS && isdigit((unsigned char)name[begin - 1]))
        begin--;
    *out = (parts){begin, end - begin, end > begin ? strtol(name + begin, NULL, 10) : 0};
    return end > begin;
}

static bool differ_otherwise(const char *one, const char *other)
{
    parts a, b;
    const size_t folder = (size_t)(file_name_of(one) - one);
    if (folder != (size_t)(file_name_of(other) - other) || strncmp(one, other, folder) != 0) return true;
    one += folder;
    other += folder;
    if (!take_apart(one, &a) || !take_apart(other, &b)) return true;
    return a.before != b.before || strncmp(one, other, a.before) != 0 ||
           strcmp(one + a.before + a.digits, other + b.before + b.digits) != 0;
}

static int by_number(const void *one, const void *other)
{
    const numbered_file *a = one, *b = other;
    return a->number < b->number ? -1 : a->number > b->number;
}

/* Sorts, and checks that the files are the frames of one sequence. */
static status order(numbered_files *files)
{
    for (size_t i = 0; i < files->count; i++)
        if (files->at[i].number < 0)
            return fail(MERLIN_BAD_INPUT, "%s has no number in its name, by which it would have a place in a sequence",
                        files->at[i].path);
    qsort(files->at, files->count, sizeof *files->at, by_number);
    for (size_t i = 1; i < files->count; i++) {
        const char *one = files->at[i - 1].path, *other = files->at[i].path;
        if (files->at[i].number == files->at[i - 1].number)
            return fail(MERLIN_BAD_INPUT, "%s and %s have the same number; a sequence has one picture for each", one,
                        other);
        if (differ_otherwise(one, other))
            return fail(MERLIN_BAD_INPUT,
                        "%s and %s are not of one sequence: the names of its pictures differ by the number alone", one,
                        other);
    }
    return OK;
}

/* Adds a file, with the number -1 if it has none. */
static status add_numbered(numbered_files *files, const char *path)
{
    parts p;
    return add(files, path, take_apart(file_name_of(path), &p) ? p.number : -1);
}

/* ---- patterns ---- */

typedef struct pattern {
    size_t at, length; /* place of the number in the name */
} pattern;

static bool find_pattern(const char *name, pattern *out)
{
    const char *percent = strchr(name, '%');
    *out = (pattern){0};
    if (percent) {
        const char *end = percent + 1;
        while (isdigit((unsigned char)*end))
            end++;
        *out = (pattern){(size_t)(percent - name), (size_t)(end + 1 - percent)};
        return *end == 'd' && !strchr(end, '%');
    }
    const char *hash = strchr(name, '#');
    if (!hash) return false;
    *out = (pattern){(size_t)(hash - name), strspn(hash, "#")};
    return !strchr(hash + out->length, '#');
}

bool numbered_is_pattern(const char *path)
{
    pattern p;
    return find_pattern(file_name_of(path), &p) && !file_exists(path);
}

/* Tells whether a name has a number in the pattern's place, and nothing else that differs. */
static bool matches(const char *name, const char *shape, pattern p, long *number)
{
    const char *behind = shape + p.at + p.length;
    const size_t length = strlen(name), rest = strlen(behind);
    if (length <= p.at + rest || strncmp(name, shape, p.at) != 0) return false;
    const size_t digits = length - p.at - rest;
    if (digits > MOST_DIGITS || strspn(name + p.at, "0123456789") < digits) return false;
    *number = strtol(name + p.at, NULL, 10);
    return strcmp(name + length - rest, behind) == 0;
}

/* Finds the masks that lie beside pictures of one folder. */
static status find_masks(numbered_files *files)
{
    img_folder f;
    char *folder = file_folder_of(files->at[0].path);
    status s = folder ? img_folder_read(folder, &f) : no_memory();
    free(folder);
    if (s != OK) return s;
    for (size_t i = 0; i < files->count && s == OK; i++) {
        const img_folder_file *mask = img_folder_mask_of(&f, file_name_of(files->at[i].path), false);
        if (!mask) continue;
        files->at[i].mask = strdup(mask->path);
        if (!files->at[i].mask) s = no_memory();
    }
    img_folder_free(&f);
    return s;
}

/* Removes files that are masks of others. */
static void drop_masks(numbered_files *files)
{
    size_t kept = 0;
    for (size_t i = 0; i < files->count; i++) {
        bool is_mask = false;
        for (size_t k = 0; k < files->count && !is_mask && merlin_mask_is_name(file_name_of(files->at[i].path)); k++)
            is_mask = k != i && files->at[k].mask &&
                      strcmp(file_name_of(files->at[k].mask), file_name_of(files->at[i].path)) == 0;
        if (is_mask) {
            free(files->at[i].path);
            free(files->at[i].mask);
        } else {
            files->at[kept++] = files->at[i];
        }
    }
    files->count = kept;
}

status numbered_of_pattern(const char *path, numbered_files *out)
{
    *out = (numbered_files){0};
    pattern p;
    const char *shape = file_name_of(path);
    char *folder = file_folder_of(path), **names = NULL;
    size_t count = 0;
    status s = folder ? file_list(folder, NULL, &names, &count) : no_memory();
    bool sound = find_pattern(shape, &p);
    for (size_t i = 0; i < count && s == OK && sound; i++) {
        long number;
        if (matches(file_name_of(names[i]), shape, p, &number)) s = add(out, names[i], number);
    }
    file_list_free(names, count);
    free(folder);
    if (s == OK && !out->count) s = fail(MERLIN_BAD_INPUT, "there is no picture %s with a number in that place", path);
    if (s == OK) s = order(out);
    if (s == OK) s = find_masks(out);
    if (s != OK) numbered_free(out);
    return s;
}

/* ---- folders and lists ---- */

status numbered_of_folder(const char *folder, const char *masks, numbered_files *out)
{
    *out = (numbered_files){0};
    merlin_photos found;
    status s = merlin_photos_list(folder, masks, &found);
    if (s != OK) return s;
    for (size_t i = 0; i < found.count && s == OK; i++) {
        s = add_numbered(out, found.at[i].path);
        if (s != OK) break;
        out->at[out->count - 1].mask = found.at[i].mask;
        found.at[i].mask = NULL; /* the list's now */
    }
    merlin_photos_free(&found);
    if (s == OK && !out->count) s = fail(MERLIN_BAD_INPUT, "there are no pictures in %s", folder);
    if (s == OK) s = order(out);
    if (s != OK) numbered_free(out);
    return s;
}

status numbered_of_paths(const char *const *paths, size_t count, numbered_files *out)
{
    *out = (numbered_files){0};
    status s = OK;
    for (size_t i = 0; i < count && s == OK; i++)
        s = add_numbered(out, paths[i]);
    if (s == OK && !out->count) s = fail(MERLIN_WRONG_USE, "a sequence has at least one picture");
    if (s == OK) s = find_masks(out);
    if (s == OK) drop_masks(out);
    if (s == OK) s = order(out);
    if (s != OK) numbered_free(out);
    return s;
}

status numbered_of_masks(const char *folder, numbered_files *out)
{
    *out = (numbered_files){0};
    char **names = NULL;
    size_t count = 0;
    status s = file_list(folder, NULL, &names, &count);
    for (size_t i = 0; i < count && s == OK; i++) {
        parts p;
        if (take_apart(file_name_of(names[i]), &p)) s = add(out, names[i], p.number);
    }
    file_list_free(names, count);
    if (s == OK && !out->count) s = fail(MERLIN_BAD_INPUT, "there are no numbered masks in the folder %s", folder);
    if (s == OK) qsort(out->at, out->count, sizeof *out->at, by_number);
    if (s != OK) numbered_free(out);
    return s;
}

numbered_file *numbered_find(const numbered_files *files, long number)
{
    const numbered_file wanted = {.number = number};
    return files->count ? bsearch(&wanted, files->at, files->count, sizeof *files->at, by_number) : NULL;
}
