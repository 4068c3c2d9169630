/* SPDX-License-Identifier: MIT */
#include "cli/check_replaced.h"

#include <limits.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/lights/light_list.h"
#include "base/text/map_names.h"
#include "merlin/mesh.h"

/* Refuses if the folder has a part of this mesh. */
static status check_mesh(const char *folder, const char *mesh)
{
    merlin_files files;
    status s = merlin_mesh_files(NULL, mesh, &files);
    for (size_t i = 0; i < files.count && s == OK; i++)
        if (map_names_is_in(folder, files.at[i])) s = map_names_refuse(folder, files.at[i], "maps.exr");
    merlin_files_free(&files);
    return s;
}

/* Tells whether a name is among others, in any case, as for readers of captures. */
static bool is_among(const char *const *names, const char *name)
{
    while (*names && strcasecmp(*names, name) != 0)
        names++;
    return *names != NULL;
}

/* Finds out whether the folder has a file with the lights of its pictures. */
static status find_capture(const char *folder, bool *holds)
{
    static const char *const data_sets[] = {"light_directions.txt", "led_params.txt", NULL};
    char **names;
    size_t count = 0;
    status s = file_list(folder, NULL, &names, &count);
    *holds = false;
    if (s != OK) return s == MERLIN_NO_MEMORY ? s : OK;
    for (size_t i = 0; i < count; i++) {
        const char *name = file_name_of(names[i]);
        *holds |= light_list_is_name(name) || is_among(data_sets, name);
    }
    file_list_free(names, count);
    return OK;
}

status check_inputs_kept(const char *folder, const char *photo, const char *mask)
{
    status s = OK;
    for (int i = 0; map_names[i] && s == OK; i++) {
        char *path = file_join(folder, map_names[i]);
        if (!path) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
        if (file_is_same(photo, path) || (mask && file_is_same(mask, path)))
            s = fail(MERLIN_CANNOT_WRITE, "cannot write %s: it is what was read; copy it, or choose another folder",
                     path);
        free(path);
    }
    return s;
}

status check_replaced(const char *folder, bool meshes)
{
    static const char *const surface[] = {"mesh.ply", "mesh.obj", "mesh.glb", NULL};
    if (map_names_is_free(folder)) return OK;
    status s = map_names_check(folder);
    for (int i = 0; meshes && s == OK && surface[i]; i++)
        s = check_mesh(folder, surface[i]);
    if (s != OK) return s;
    bool holds;
    s = find_capture(folder, &holds);
    if (s != OK || !holds) return s;
    return fail(MERLIN_CANNOT_WRITE,
                "cannot write into %s: it holds a capture, whose pictures and mask the results would be taken for the "
                "next time; choose another folder",
                folder);
}

/* ---- lists of lights ---- */

static bool begins_with(const char *line, const char *words)
{
    return strncmp(line, words, strlen(words)) == 0;
}

static bool is_ours(const char *line)
{
    return begins_with(line, LIGHT_LIST_OF_CALIBRATION) || begins_with(line, LIST_OF_PLACES);
}

enum { FIRST_LINE = 64 };

/* Reads the first letters of the folder's lights.txt; returns false if there is no such file, or it is empty. It
 * allocates nothing, so that lack of memory cannot hide a user's list. */
static bool read_list(const char *folder, char line[FIRST_LINE])
{
    char path[PATH_MAX];
    const int length = snprintf(path, sizeof path, "%s/lights.txt", folder);
    if (length < 0 || (size_t)length >= sizeof path) return false;
    const int file = file_open_descriptor(path);
    if (file < 0) return false;
    struct stat about;
    const bool plain = fstat(file, &about) == 0 && S_ISREG(about.st_mode);
    const ssize_t got = plain ? read(file, line, FIRST_LINE - 1) : 0;
    close(file);
    if (got <= 0) return false;
    line[got] = 0;
    return true;
}

bool list_begins_with(const char *folder, const char *words)
{
    char line[FIRST_LINE];
    return read_list(folder, line) && begins_with(line, words);
}

status check_list_replaced(const char *folder)
{
    char line[FIRST_LINE];
    if (!read_list(folder, line) || is_ours(line)) return OK;
    return fail(
        MERLIN_CANNOT_WRITE,
        "cannot write %s%slights.txt: it is no earlier result, and would be replaced; rename it, or choose another "
        "folder",
        folder, file_ends_in(folder, "/") ? "" : "/");
}
