#include "cli/check_replaced.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"

static status refuse(const char *folder, const char *name)
{
    return fail(ERROR_OUTPUT,
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

/* The first of the names that a file of the folder has; NULL if none has. */
static const char *first_in(const char *folder, const char *const *names)
{
    while (*names && !is_file_in(folder, *names))
        names++;
    return *names;
}

/* What says of the pictures beside it where their lights were. */
static bool holds_capture(const char *folder)
{
    static const char *const lists[] = {"lights.txt",           "lights.csv",     "lights.tsv", "lights.dat",
                                        "light_directions.txt", "led_params.txt", NULL};
    static const char *const endings[] = {".lp", NULL};
    char **names;
    size_t count = 0;
    if (first_in(folder, lists)) return true;
    if (file_list(folder, endings, &names, &count) == OK) file_list_free(names, count);
    return count > 0;
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
    return fail(ERROR_OUTPUT,
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
    return begins_with(line, "# Directions to the lights, found from") || begins_with(line, "# places of the lamps of");
}

status check_list_replaced(const char *folder)
{
    char *path = file_join(folder, "lights.txt"), line[64];
    if (!path) return fail(ERROR_MEMORY, "no memory for a file name");
    FILE *f = file_is_folder(path) ? NULL : file_open(path);
    status s = OK;
    if (f && fgets(line, sizeof line, f) && !is_ours(line))
        s = fail(ERROR_OUTPUT,
                 "cannot write %s: it is no earlier result, and would be replaced; rename it, or choose another folder",
                 path);
    if (f) fclose(f);
    free(path);
    return s;
}
