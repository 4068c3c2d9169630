/* SPDX-License-Identifier: MIT */
/* Writes a mesh to the format that its file's name ends in, and tells which files that made. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "base/text/mesh_parts.h"
#include "mesh/write/mesh_formats.h"

typedef struct format {
    const char *ending;
    status (*write)(const char *path, const merlin_mesh *m);
} format;

static const format formats[] = {
    {".ply", mesh_write_ply},
    {".obj", mesh_write_obj},
    {".glb", mesh_write_glb},
    {".usda", mesh_write_usda},
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

static bool has(const merlin_mesh *m, mesh_part part)
{
    switch (part) {
    case MESH_ALBEDO:
        return m->albedo.data != NULL;
    case MESH_NORMAL:
        return m->face_normals != NULL;
    case MESH_ROUGHNESS:
        return m->roughness.data != NULL;
    default:
        return true;
    }
}

static int compare_paths(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

merlin_status merlin_mesh_files(const merlin_mesh *mesh, const char *path, merlin_files *out)
{
    if (out) *out = (merlin_files){0};
    status s = api_needs(__func__, path && out);
    if (s == OK) s = merlin_mesh_check_name(path);
    if (s != OK) return s;
    out->at = calloc(MESH_PARTS, sizeof *out->at);
    bool lost = !out->at;
    for (mesh_part part = MESH_SCENE; !lost && part < MESH_PARTS; part++) {
        if (!mesh_part_ending(path, part) || (mesh && !has(mesh, part))) continue;
        lost = !(out->at[out->count] = mesh_part_path(path, part));
        out->count += !lost;
    }
    if (!lost) {
        qsort(out->at, out->count, sizeof *out->at, compare_paths);
        return OK;
    }
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
    /* before anything is written, so that a lack of memory leaves no file */
    if (s == OK) s = merlin_mesh_files(mesh, path, &files);
    for (size_t i = 0; s == OK && i < files.count; i++)
        s = mesh_part_check(path, files.at[i]);
    if (s == OK) s = format_of(path)->write(path, mesh);
    if (s == OK && written) {
        add_sizes(&files);
        *written = files;
        return s;
    }
    merlin_files_free(&files);
    return s;
}
