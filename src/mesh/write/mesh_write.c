/* SPDX-License-Identifier: MIT */
#include "mesh/write/mesh_write.h"

#include "base/file.h"
#include "mesh/write/mesh_formats.h"

typedef struct format {
    const char *ending;
    status (*write)(const char *path, const surface_mesh *m, const mesh_source *from);
} format;

static const format formats[] = {{".ply", mesh_write_ply}, {".obj", mesh_write_obj}, {".glb", mesh_write_glb}};
enum { FORMATS = sizeof formats / sizeof formats[0] };

static const format *format_of(const char *path)
{
    for (int i = 0; i < FORMATS; i++)
        if (file_ends_in(path, formats[i].ending)) return &formats[i];
    return NULL;
}

status mesh_check_name(const char *path)
{
    return format_of(path) ? OK : fail(MERLIN_WRONG_USE, "%s: a mesh's name ends in .ply, .obj or .glb", path);
}

status mesh_write(const char *path, const mesh_source *from)
{
    surface_mesh m;
    status s = mesh_check_name(path);
    if (s == OK) s = file_check_writable(path);
    if (s == OK) s = surface_mesh_new(from, &m);
    if (s != OK) return s;
    s = format_of(path)->write(path, &m, from);
    surface_mesh_free(&m);
    return s;
}
