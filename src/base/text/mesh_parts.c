/* SPDX-License-Identifier: MIT */
#include "base/text/mesh_parts.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"

static const char *const endings[][MESH_PARTS] = {
    {[MESH_SCENE] = ".ply"},
    {[MESH_SCENE] = ".obj", [MESH_MATERIAL] = ".mtl", [MESH_ALBEDO] = ".png"},
    {[MESH_SCENE] = ".glb"},
    {[MESH_SCENE] = ".usda",
     [MESH_ALBEDO] = ".png",
     [MESH_NORMAL] = "_normal.png",
     [MESH_ROUGHNESS] = "_roughness.png"},
};
enum { KINDS = sizeof endings / sizeof *endings };

const char *mesh_part_ending(const char *mesh, mesh_part part)
{
    for (int i = 0; i < KINDS; i++)
        if (file_ends_in(mesh, endings[i][MESH_SCENE])) return endings[i][part];
    return NULL;
}

/* Returns the length of a mesh's path without its ending. */
static size_t stem_of(const char *path)
{
    return strlen(path) - strlen(mesh_part_ending(path, MESH_SCENE));
}

/* Returns a mesh's path with another ending. */
static char *with_ending(const char *path, const char *ending)
{
    char *out = NULL;
    return asprintf(&out, "%.*s%s", (int)stem_of(path), path, ending) < 0 ? NULL : out;
}

char *mesh_part_path(const char *path, mesh_part part)
{
    if (part == MESH_SCENE) return strdup(path); /* its ending keeps its case */
    return with_ending(path, mesh_part_ending(path, part));
}

static bool has_ending(const char *const parts[MESH_PARTS], const char *ending)
{
    bool found = false;
    for (int part = MESH_MATERIAL; part < MESH_PARTS; part++)
        found |= parts[part] && strcmp(parts[part], ending) == 0;
    return found;
}

status mesh_part_check(const char *mesh, const char *file)
{
    bool owned = !file_exists(file) || file_exists(mesh);
    for (int i = 0; i < KINDS && !owned; i++) {
        if (!has_ending(endings[i], file + stem_of(mesh))) continue;
        char *other = with_ending(mesh, endings[i][MESH_SCENE]);
        if (!other) return fail(MERLIN_NO_MEMORY, "no memory for file names");
        owned = file_exists(other);
        free(other);
    }
    if (owned) return OK;
    return fail(MERLIN_CANNOT_WRITE,
                "cannot write %s: %s is no part of an earlier one, and would be replaced; choose another name", mesh,
                file);
}
