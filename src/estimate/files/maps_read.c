/* SPDX-License-Identifier: MIT */
/* merlin_maps_read: the maps of a folder, of a photograph or of a captured surface. */
#include <stdlib.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "estimate/files/maps_files.h"

/* A surface's files say what their error map shows, which photographs have none of. */
static bool is_captured(const exr_file *f)
{
    return exr_get_text(f, "merlinError") != NULL;
}

static char *path_in(const char *folder)
{
    char *path = file_join(folder, "maps.exr");
    if (!path) fail(MERLIN_NO_MEMORY, "no memory for a file name");
    return path;
}

merlin_status merlin_maps_look(const char *folder, int *captured)
{
    if (captured) *captured = 0;
    status s = api_needs(__func__, folder && captured);
    if (s != OK) return s;
    char *path = path_in(folder);
    exr_file *f = NULL;
    s = path ? exr_open(path, &f) : MERLIN_NO_MEMORY;
    *captured = s == OK && is_captured(f);
    exr_close(f);
    free(path);
    return s == MERLIN_NO_MEMORY ? s : OK;
}

merlin_status merlin_maps_read(const char *folder, merlin_maps *maps)
{
    if (maps) *maps = (merlin_maps){0};
    status s = api_needs(__func__, folder && maps);
    if (s != OK) return s;
    char *path = path_in(folder);
    if (!path) return MERLIN_NO_MEMORY;
    exr_file *f = NULL;
    s = file_exists(path)
            ? exr_open(path, &f)
            : fail(
                  MERLIN_BAD_INPUT,
                  "no maps.exr in %s: merlin estimate makes one of a photograph, merlin stereo of a folder of pictures",
                  folder);
    if (s == OK) s = is_captured(f) ? maps_read_captured(f, path, maps) : maps_read_photographed(f, path, maps);
    if (f) exr_close(f);
    free(path);
    if (s != OK) merlin_maps_free(maps);
    return s;
}
