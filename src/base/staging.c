/* SPDX-License-Identifier: MIT */
#include "base/staging.h"

#include <dirent.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/leftovers.h"

struct staging {
    char *folder, *hidden;
    size_t kept; /* length of the part of folder's path that existed before */
    DIR *files;  /* the hidden folder, open for listing when its files are moved */
    const char *inputs[STAGING_MOST_INPUTS];
    char **dropped; /* paths of files that are removed at the commit */
    size_t dropped_count;
};

static bool is_input(const staging *t, const char *path)
{
    for (int i = 0; i < STAGING_MOST_INPUTS; i++)
        if (t->inputs[i] && file_is_same(t->inputs[i], path)) return true;
    return false;
}

static void staging_free(staging *t)
{
    if (t->hidden) leftovers_forget(t->hidden);
    if (t->files) closedir(t->files);
    file_list_free(t->dropped, t->dropped_count);
    free(t->folder);
    free(t->hidden);
    free(t);
}

static size_t existing_length(const char *folder)
{
    char path[PATH_MAX];
    size_t length = strlen(folder);
    if (length >= sizeof path) return length;
    memcpy(path, folder, length + 1);
    while (length > 0 && !file_exists(path)) {
        while (length > 0 && path[length - 1] != '/')
            length--;
        while (length > 0 && path[length - 1] == '/')
            length--;
        path[length] = 0;
    }
    return length;
}

/* Removes the folders that were made, innermost first. */
static void remove_made(const staging *t)
{
    char path[PATH_MAX];
    size_t length = strlen(t->folder);
    if (length >= sizeof path) return;
    memcpy(path, t->folder, length + 1);
    while (length > t->kept && rmdir(path) == 0) {
        while (length > t->kept && path[length - 1] == '/')
            length--;
        while (length > t->kept && path[length - 1] != '/')
            length--;
        while (length > t->kept && path[length - 1] == '/')
            length--;
        path[length] = 0;
    }
}

static status begin(staging *t)
{
    if (strlen(t->hidden) + 1 + NAME_MAX >= PATH_MAX)
        return fail(MERLIN_CANNOT_WRITE, "cannot write: a path of %zu bytes is too long: %s", strlen(t->folder),
                    t->folder);
    t->kept = existing_length(t->folder);
    status s = file_make_folder(t->folder);
    if (s == OK) leftovers_clear(t->folder);
    if (s == OK && !mkdtemp(t->hidden)) s = fail_by_errno(MERLIN_CANNOT_WRITE, "cannot write into %s", t->folder);
    if (s != OK) remove_made(t);
    if (s == OK) leftovers_note(t->hidden, t->kept ? t->kept : 1);
    return s;
}

static char *hidden_in(const char *folder)
{
    char name[LEFTOVERS_NAME];
    leftovers_folder_name(name);
    return file_join(folder, name);
}

status staging_begin(const char *folder, const char *const *inputs, staging **out)
{
    *out = NULL;
    staging *t = calloc(1, sizeof *t);
    if (!t) return fail(MERLIN_NO_MEMORY, "no memory to write %s", folder);
    t->folder = strdup(folder);
    t->hidden = hidden_in(folder);
    if (inputs) memcpy(t->inputs, inputs, sizeof t->inputs);
    status s = t->folder && t->hidden ? begin(t) : fail(MERLIN_NO_MEMORY, "no memory to write %s", folder);
    if (s != OK)
        staging_free(t);
    else
        *out = t;
    return s;
}

const char *staging_folder(const staging *t)
{
    return t->hidden;
}

const char *staging_path(const staging *t, const char *name, char path[PATH_MAX])
{
    snprintf(path, PATH_MAX, "%s/%s", t->hidden, name);
    return path;
}

status staging_drop(staging *t, const char *name)
{
    char **larger = realloc(t->dropped, (t->dropped_count + 1) * sizeof *larger);
    if (larger) t->dropped = larger;
    char *path = larger ? file_join(t->folder, name) : NULL;
    if (!path) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    t->dropped[t->dropped_count++] = path;
    return OK;
}

status staging_drop_numbered(staging *t, const char *before, const char *after)
{
    char name[NAME_MAX + 1];
    status s = OK;
    for (int i = 0; s == OK; i++) {
        snprintf(name, sizeof name, "%s%d%s", before, i, after);
        if (!file_is_in(t->folder, name)) return OK;
        s = staging_drop(t, name);
    }
    return s;
}

static bool is_dots(const char *name)
{
    return strcmp(name, ".") == 0 || strcmp(name, "..") == 0;
}

/* ---- what was written ---- */

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static status add_size(staged_files *files, const char *path)
{
    struct stat found;
    if (stat(path, &found) != 0) return fail_by_errno(MERLIN_CANNOT_WRITE, "cannot write %s", path);
    files->bytes += (uint64_t)found.st_size;
    return OK;
}

static status add_written(staged_files *files, const char *path)
{
    char **larger = realloc(files->at, (files->count + 1) * sizeof *larger);
    if (larger) files->at = larger;
    char *copy = larger ? strdup(path) : NULL;
    if (!copy) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    files->at[files->count++] = copy;
    return OK;
}

void merlin_files_free(merlin_files *files)
{
    if (!files) return;
    file_list_free(files->at, files->count);
    *files = (merlin_files){0};
}

/* ---- into place ---- */

static status check(const staging *t, const char *from, const char *to, staged_files *written)
{
    if (file_is_folder(to)) return fail(MERLIN_CANNOT_WRITE, "cannot write %s: a folder is in the way", to);
    if (is_input(t, to))
        return fail(MERLIN_CANNOT_WRITE, "cannot write %s: it is what was read; choose another name or folder", to);
    if (!written) return OK;
    status s = add_size(written, from);
    return s == OK ? add_written(written, to) : s;
}

static status move(const char *from, const char *to)
{
    return rename(from, to) == 0 ? OK : fail_by_errno(MERLIN_CANNOT_WRITE, "cannot write %s", to);
}

static status over_files(const staging *t, bool only_check, staged_files *written)
{
    char from[PATH_MAX], to[PATH_MAX];
    const char *between = t->folder[0] && t->folder[strlen(t->folder) - 1] == '/' ? "" : "/";
    status s = OK;
    rewinddir(t->files);
    for (struct dirent *e; s == OK && (e = readdir(t->files));) {
        if (is_dots(e->d_name)) continue;
        staging_path(t, e->d_name, from);
        /* shorter than the other path, which fits (begin) */
        snprintf(to, sizeof to, "%s%s%s", t->folder, between, e->d_name);
        s = only_check ? check(t, from, to, written) : move(from, to);
    }
    return s;
}

/* Allocates everything before anything is moved, so that a lack of memory moves nothing. */
static status check_files(staging *t, staged_files *written)
{
    t->files = opendir(t->hidden);
    return t->files ? over_files(t, true, written)
                    : fail_by_errno(MERLIN_CANNOT_WRITE, "cannot write into %s", t->folder);
}

/* Keeps only those files marked that are there and are not replaced; inputs and folders stay, too. */
static void choose_dropped(staging *t)
{
    size_t kept = 0;
    for (size_t i = 0; i < t->dropped_count; i++) {
        char *path = t->dropped[i];
        if (file_is_in(t->hidden, file_name_of(path)) || is_input(t, path) || file_is_folder(path))
            free(path);
        else
            t->dropped[kept++] = path;
    }
    t->dropped_count = kept;
}

static void remove_dropped(const staging *t)
{
    for (size_t i = 0; i < t->dropped_count; i++)
        (void)unlink(t->dropped[i]);
}

/* Checks all folders before it moves any file. */
status staging_commit_all(staging *const *t, int count, staged_files *written)
{
    status s = OK;
    for (int i = 0; i < count && s == OK; i++)
        s = check_files(t[i], written);
    for (int i = 0; i < count && s == OK; i++)
        choose_dropped(t[i]);
    for (int i = 0; i < count && s == OK; i++)
        s = over_files(t[i], false, NULL);
    for (int i = 0; i < count && s == OK; i++)
        remove_dropped(t[i]);
    if (s == OK && written && written->count > 1)
        qsort(written->at, written->count, sizeof *written->at, compare_names);
    for (int i = count - 1; i >= 0; i--) {
        if (s != OK) {
            s = staging_abort(t[i], s);
            continue;
        }
        rmdir(t[i]->hidden);
        staging_free(t[i]);
    }
    return s;
}

status staging_commit(staging *t, staged_files *written)
{
    return staging_commit_all(&t, 1, written);
}

status staging_abort(staging *t, status s)
{
    s = fail_shown(s, t->hidden, t->folder);
    leftovers_remove_folder(t->hidden);
    remove_made(t);
    staging_free(t);
    return s;
}
