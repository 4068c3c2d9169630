/* SPDX-License-Identifier: MIT */
#include "cli/check_replaced.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/lights/light_list.h"

static status refuse(const char *folder, const char *name)
{
    return fail(MERLIN_CANNOT_WRITE,
                "cannot write into %s: its %s is no earlier result, for there is no maps.exr beside it, and would be "
                "replaced; choose another folder",
                folder, name);
}

static bool is_file_in(const char *folder, const char *name)
{
    char *path = file_join(folder, name);
    bool is = path && file_exists(path) && !file_is_folder(path);
    free(path);
    return is;
}

/* Returns the first of the names that a file of the folder has; NULL if none has. */
static const char *first_in(const char *folder, const char *const *names)
{
    while (*names && !is_file_in(folder, *names))
        names++;
    return *names;
}

/* In capitals or not, as readers of captures have it. */
static bool is_among(const char *const *names, const char *name)
{
    while (*names && strcasecmp(*names, name) != 0)
        names++;
    return *names != NULL;
}

/* Tells whether the folder has a file that says where the lights of the pictures beside it were. */
static bool holds_capture(const char *folder)
{
    static const char *const data_sets[] = {"light_directions.txt", "led_params.txt", NULL};
    char **names;
    size_t count = 0;
    bool holds = false;
    if (file_list(folder, NULL, &names, &count) != OK) return false;
    for (size_t i = 0; i < count; i++) {
        const char *name = file_name_of(names[i]);
        holds |= is_among(light_list_names, name) || is_among(data_sets, name) || file_ends_in(name, ".lp");
    }
    file_list_free(names, count);
    return holds;
}

status check_replaced(const char *folder, bool meshes)
{
    static const char *const own[] = {"maps.exr", "report.json", NULL};
    static const char *const maps[] = {"mask.png",           "normal.png",   "albedo.png",
                                       "roughness.png",      "depth.png",    "error.png",
                                       "reconstruction.png", "overview.png", NULL};
    static const char *const surface[] = {"mesh.ply", "mesh.obj", "mesh.mtl", "mesh.png", "mesh.glb", NULL};
    if (!file_is_folder(folder) || first_in(folder, own)) return OK;
    const char *name = first_in(folder, maps);
    if (!name && meshes) name = first_in(folder, surface);
    if (name) return refuse(folder, name);
    if (!holds_capture(folder)) return OK;
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

/* Reads a file's first letters; false where there is no file, or nothing in it. */
static bool read_first_line(const char *path, char line[FIRST_LINE])
{
    FILE *f = file_is_folder(path) ? NULL : file_open(path);
    const bool got = f && fgets(line, FIRST_LINE, f);
    if (f) fclose(f);
    return got;
}

bool list_begins_with(const char *folder, const char *words)
{
    char *path = file_join(folder, "lights.txt"), line[FIRST_LINE];
    const bool begins = path && read_first_line(path, line) && begins_with(line, words);
    free(path);
    return begins;
}

status check_list_replaced(const char *folder)
{
    char *path = file_join(folder, "lights.txt"), line[FIRST_LINE];
    if (!path) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    status s = OK;
    if (read_first_line(path, line) && !is_ours(line))
        s = fail(MERLIN_CANNOT_WRITE,
                 "cannot write %s: it is no earlier result, and would be replaced; rename it, or choose another folder",
                 path);
    free(path);
    return s;
}
