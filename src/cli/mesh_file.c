/* SPDX-License-Identifier: MIT */
#include "cli/mesh_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/text/mesh_parts.h"
#include "merlin/mesh.h"

status mesh_take_name(const char *path, void *into)
{
    mesh_names *names = into;
    if (names->count == MESH_MOST_FILES) return fail(MERLIN_WRONG_USE, "--mesh may be given %d times", MESH_MOST_FILES);
    names->at[names->count++] = path;
    return merlin_mesh_check_name(path);
}

bool mesh_is_name(const char *word)
{
    static const char *const endings[] = {".ply", ".obj", ".glb", ".usda", ".gltf",  ".stl", ".off",
                                          ".fbx", ".dae", ".3mf", ".usdz", ".blend", NULL};
    return file_ends_in_any(word, endings);
}

/* Checks a file beside an OBJ or USD, which has the mesh's name: it must not replace a map or what is no part of an
 * earlier mesh, nor be in the folder of pictures to solve, where a texture would replace one of them or be
 * one more the next time. */
static status check_part(const mesh_file *m, const char *folder, const char *path)
{
    const char *name = file_name_of(path), *input = m->inputs[0];
    const bool texture = file_ends_in(name, ".png");
    char aside[PATH_MAX];
    if (file_is_same(folder, m->folder) && file_exists(staging_path(m->maps, name, aside)))
        return fail(MERLIN_CANNOT_WRITE, "cannot write %s: its texture would replace the map %s; choose another name",
                    m->path, name);
    if (texture && file_is_folder(input) && file_is_same(folder, input) &&
        (file_is_in(input, name) || !file_is_in(input, "maps.exr")))
        return fail(MERLIN_CANNOT_WRITE,
                    "cannot write %s: its texture %s would lie among what is read; choose another folder", m->path,
                    name);
    for (int i = 0; i < STAGING_MOST_INPUTS; i++)
        if (m->inputs[i] && file_is_same(path, m->inputs[i])) return OK; /* which the commit refuses to replace */
    return mesh_part_check(m->path, path);
}

static status check_parts(const mesh_file *m, const char *folder)
{
    merlin_files files;
    status s = merlin_mesh_files(m->mesh, m->path, &files);
    for (size_t i = 0; i < files.count && s == OK; i++)
        if (strcmp(files.at[i], m->path) != 0) s = check_part(m, folder, files.at[i]);
    merlin_files_free(&files);
    return s;
}

status mesh_file_stage(const mesh_file *m, staging **out)
{
    *out = NULL;
    if (file_is_folder(m->path)) return fail(MERLIN_CANNOT_WRITE, "cannot write %s: it is a folder", m->path);
    char *folder = file_folder_of(m->path);
    status s = folder ? staging_begin(folder, m->inputs, out) : fail(MERLIN_NO_MEMORY, "no memory for a file name");
    s = s == OK ? check_parts(m, folder) : fail_in(s, "cannot write %s", m->path);
    free(folder);
    if (s != OK) return s;
    char aside[PATH_MAX];
    return merlin_mesh_write(m->mesh, staging_path(*out, file_name_of(m->path), aside), NULL);
}
