/* SPDX-License-Identifier: MIT */
#include "base/text/map_names.h"

#include <stddef.h>
#include <stdlib.h>

#include "base/file.h"

const char *const map_names[] = {"mask.png",  "normal.png",         "albedo.png",   "roughness.png",  "depth.png",
                                 "error.png", "reconstruction.png", "overview.png", "confidence.png", NULL};

status map_names_refuse(const char *folder, const char *name, const char *beside)
{
    return fail(MERLIN_CANNOT_WRITE,
                "cannot write into %s: its %s is no earlier result, for there is no %s beside it, and would be "
                "replaced; choose another folder",
                folder, name, beside);
}

bool map_names_is_in(const char *folder, const char *name)
{
    char *path = file_join(folder, name);
    bool is = path && file_exists(path) && !file_is_folder(path);
    free(path);
    return is;
}

bool map_names_is_free(const char *folder)
{
    return !file_is_folder(folder) || map_names_is_in(folder, "maps.exr") || map_names_is_in(folder, "report.json");
}

status map_names_check(const char *folder)
{
    if (map_names_is_free(folder)) return OK;
    for (int i = 0; map_names[i]; i++)
        if (map_names_is_in(folder, map_names[i])) return map_names_refuse(folder, map_names[i], "maps.exr");
    return OK;
}
