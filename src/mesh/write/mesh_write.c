/* SPDX-License-Identifier: MIT */
/* Writes a mesh to the format that its file's name ends in, and tells which files that made. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "mesh/write/mesh_formats.h"

enum { MOST_FILES = 4 };

/* Condition on a mesh for one of a format's files. */
typedef enum need { NEEDS_NOTHING, NEEDS_ALBEDO, NEEDS_FACE_NORMALS, NEEDS_ROUGHNESS } need;

typedef struct format {
    const char *ending;
    status (*write)(const char *path, const merlin_mesh *m);
    struct {
        const char *ending;
        need need;
    } files[MOST_FILES]; /* sorted, behind the last one NULL */
} format;

static const format formats[] = {
    {".ply", mesh_write_ply, {{".ply", NEEDS_NOTHING}}},
    {".obj", mesh_write_obj, {{".mtl", NEEDS_NOTHING}, {".obj", NEEDS_NOTHING}, {".png", NEEDS_ALBEDO}}},
    {".glb", mesh_write_glb, {{".glb", NEEDS_NOTHING}}},
    {".usda",
     mesh_write_usda,
     {{".png", NEEDS_ALBEDO},
      {".usda", NEEDS_NOTHING},
      {"_normal.png", NEEDS_FACE_NORMALS},
      {"_roughness.png", NEEDS_ROUGHNESS}}},
};
enum { FORMATS = sizeof formats / sizeof formats[0] };

static const format *format_of(const char *path)
{
    for (int i = 0; i < FORMATS; i++)
        if (file_ends_in(path, formats[i].ending)) return &formats[i];
    return NULL;
}

merlin_status merlin_mesh_check_name(const char *path)
{
    status s = api_needs(__func__, path);
    if (s != OK) return s;
    return format_of(path) ? OK : fail(MERLIN_WRONG_USE, "%s: a mesh's name ends in .ply, .obj, .glb or .usda", path);
}

/* ---- meshes that anybody may have made ---- */

static bool all_below(const uint32_t *numbers, size_t count, size_t limit)
{
    for (size_t i = 0; i < count; i++)
        if (numbers[i] >= limit) return false;
    return true;
}

static bool is_texture(const merlin_image *image, int channels)
{
    return !image->data || (image->channels == channels && image->width > 0 && image->height > 0);
}

static status check(const merlin_mesh *m)
{
    if (!m->vertex_count || !m->positions || !m->normals || !m->uvs || (m->triangle_count && !m->triangles))
        return fail(MERLIN_WRONG_USE, "this mesh is empty or incomplete");
    if (!all_below(m->triangles, 3 * m->triangle_count, m->vertex_count))
        return fail(MERLIN_WRONG_USE, "a triangle of this mesh has a vertex that is not there");
    if (!is_texture(&m->albedo, 3) || !is_texture(&m->roughness, 1))
        return fail(MERLIN_WRONG_USE, "a mesh's albedo has 3 channels, its roughness 1");
    if (!m->face_normals) return OK;
    bool placed = m->pixels && m->width > 0 && m->height > 0 &&
                  all_below(m->pixels, m->vertex_count, (size_t)m->width * (size_t)m->height);
    return placed ? OK : fail(MERLIN_WRONG_USE, "a mesh with face_normals wants the pixels of its vertices");
}

/* ---- what is written ---- */

static bool has(const merlin_mesh *m, need n)
{
    switch (n) {
    case NEEDS_ALBEDO:
        return m->albedo.data != NULL;
    case NEEDS_FACE_NORMALS:
        return m->face_normals != NULL;
    case NEEDS_ROUGHNESS:
        return m->roughness.data != NULL;
    default:
        return true;
    }
}

/* Lists names before anything is written, so that a lack of memory leaves no file. */
static status list_files(const format *f, const char *path, const merlin_mesh *m, merlin_files *out)
{
    const int stem = (int)(strlen(path) - strlen(f->ending));
    out->at = calloc(MOST_FILES, sizeof *out->at);
    bool lost = !out->at;
    for (size_t i = 0; !lost && i < MOST_FILES && f->files[i].ending; i++) {
        if (!has(m, f->files[i].need)) continue;
        /* the ending that was asked for keeps its case */
        const char *ending = strcmp(f->files[i].ending, f->ending) == 0 ? path + stem : f->files[i].ending;
        lost = asprintf(&out->at[out->count], "%.*s%s", stem, path, ending) < 0;
        out->count += !lost;
    }
    if (!lost) return OK;
    merlin_files_free(out);
    return fail(MERLIN_NO_MEMORY, "no memory for file names");
}

static void add_sizes(merlin_files *files)
{
    struct stat about;
    for (size_t i = 0; i < files->count; i++)
        if (stat(files->at[i], &about) == 0) files->bytes += (uint64_t)about.st_size;
}

merlin_status merlin_mesh_write(const merlin_mesh *mesh, const char *path, merlin_files *written)
{
    merlin_files files = {0};
    if (written) *written = files;
    status s = api_needs(__func__, mesh && path);
    if (s == OK) s = merlin_mesh_check_name(path);
    if (s == OK) s = check(mesh);
    if (s == OK) s = file_check_writable(path);
    if (s == OK) s = list_files(format_of(path), path, mesh, &files);
    if (s == OK) s = format_of(path)->write(path, mesh);
    if (s == OK && written) {
        add_sizes(&files);
        *written = files;
        return s;
    }
    merlin_files_free(&files);
    return s;
}
