/* SPDX-License-Identifier: MIT */
#include "cli/mesh_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
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

/* Endings of the pictures beside a mesh, which take the place of its own. */
static const char *const obj_textures[] = {".png", NULL}, *const no_textures[] = {NULL};
static const char *const usd_textures[] = {".png", "_normal.png", "_roughness.png", NULL};

static const char *const *textures_of(const char *name)
{
    return file_ends_in(name, ".obj") ? obj_textures : file_ends_in(name, ".usda") ? usd_textures : no_textures;
}

/* Checks a texture of an OBJ or USD, a picture with the mesh's name: it must not replace a map, nor be in the folder of
 * pictures to solve, where it would replace one of them or be one more the next time. */
static status check_texture(const mesh_file *m, const char *folder, const char *ending)
{
    const char *name = file_name_of(m->path), *input = m->inputs[0];
    char texture[NAME_MAX + 32], aside[PATH_MAX];
    snprintf(texture, sizeof texture, "%.*s%s", (int)(strrchr(name, '.') - name), name, ending);
    if (file_is_same(folder, m->folder) && file_exists(staging_path(m->maps, texture, aside)))
        return fail(MERLIN_CANNOT_WRITE, "cannot write %s: its texture would replace the map %s; choose another name",
                    m->path, texture);
    if (file_is_folder(input) && file_is_same(folder, input) &&
        (file_is_in(input, texture) || !file_is_in(input, "maps.exr")))
        return fail(MERLIN_CANNOT_WRITE,
                    "cannot write %s: its texture %s would lie among what is read; choose another folder", m->path,
                    texture);
    return OK;
}

static status check_textures(const mesh_file *m, const char *folder)
{
    status s = OK;
    for (const char *const *ending = textures_of(file_name_of(m->path)); s == OK && *ending; ending++)
        s = check_texture(m, folder, *ending);
    return s;
}

status mesh_file_stage(const mesh_file *m, staging **out)
{
    *out = NULL;
    if (file_is_folder(m->path)) return fail(MERLIN_CANNOT_WRITE, "cannot write %s: it is a folder", m->path);
    char *folder = file_folder_of(m->path);
    status s = folder ? staging_begin(folder, m->inputs, out) : fail(MERLIN_NO_MEMORY, "no memory for a file name");
    s = s == OK ? check_textures(m, folder) : fail_in(s, "cannot write %s", m->path);
    free(folder);
    if (s != OK) return s;
    char aside[PATH_MAX];
    return merlin_mesh_write(m->mesh, staging_path(*out, file_name_of(m->path), aside), NULL);
}
