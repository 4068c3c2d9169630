/* SPDX-License-Identifier: MIT */
/* The photographs of a folder, and whose the masks in it are (merlin/photos.h). */
#include "merlin/photos.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "base/skipped.h"
#include "base/text/map_names.h"
#include "base/text/mesh_parts.h"
#include "image/read/folder.h"
#include "image/read/mask_names.h"
#include "image/read/read.h"

/* Tells whether a name is that of a part of a mesh.ply, mesh.obj or the like. */
static bool is_mesh_name(const char *name)
{
    static const char *const meshes[] = {"mesh.ply", "mesh.obj", "mesh.glb", "mesh.usda"};
    const size_t stem = strlen("mesh");
    if (strncmp(name, "mesh", stem) != 0) return false;
    for (size_t i = 0; i < sizeof meshes / sizeof meshes[0]; i++)
        for (mesh_part part = MESH_SCENE; part < MESH_PARTS; part++) {
            const char *ending = mesh_part_ending(meshes[i], part);
            if (ending && strcmp(name + stem, ending) == 0) return true;
        }
    return false;
}

/* Tells whether estimate and stereo write a file of this name with maps.exr. */
static bool is_result_name(const char *name)
{
    for (int i = 0; map_names[i]; i++)
        if (strcmp(name, map_names[i]) == 0) return true;
    return strcmp(name, "maps.exr") == 0 || strcmp(name, "report.json") == 0 || is_mesh_name(name);
}

static status no_memory(void)
{
    return fail(MERLIN_NO_MEMORY, "no memory for file names");
}

static status copy_path(const char *path, char **copy)
{
    *copy = strdup(path);
    return *copy ? OK : no_memory();
}

/* ---- a folder of photographs ---- */

/* Reads a folder. If it has maps.exr, the program's results are excluded, and a mask among them belongs to no
 * photograph. */
static status read_folder(const char *folder, img_folder *f, bool *results)
{
    status s = img_folder_read(folder, f);
    if (s != OK) return s;
    *results = file_is_in(folder, "maps.exr");
    size_t kept = 0;
    for (size_t i = 0; i < f->count; i++)
        if (*results && is_result_name(f->at[i].name))
            free(f->at[i].path);
        else
            f->at[kept++] = f->at[i];
    f->count = kept;
    return OK;
}

/* Tells whether a name is the mesh's, NAME.mtl, with the ending of a texture in the place of its own. */
static bool is_texture_of(const char *texture, const char *ending, const char *mesh)
{
    if (!file_ends_in(texture, ending)) return false;
    const size_t stem = strlen(texture) - strlen(ending);
    return strncmp(mesh, texture, stem) == 0 && mesh[stem] == '.' && !strchr(mesh + stem + 1, '.');
}

/* Tells whether a picture is a texture of a mesh; that of an OBJ is known by its material. */
static bool is_texture_for(const char *picture, const char *mesh)
{
    const char *kind = file_ends_in(mesh, ".mtl") ? "mesh.obj" : file_ends_in(mesh, ".usda") ? mesh : NULL;
    for (mesh_part part = MESH_ALBEDO; kind && part < MESH_PARTS; part++) {
        const char *ending = mesh_part_ending(kind, part);
        if (ending && is_texture_of(picture, ending, mesh)) return true;
    }
    return false;
}

/* Tells whether a picture is a texture of an OBJ or USD that --mesh named. */
static bool is_texture(const img_folder *f, const img_folder_file *file)
{
    for (size_t i = 0; i < f->count && file_ends_in(file->name, ".png"); i++)
        if (is_texture_for(file->name, f->at[i].name)) return true;
    return false;
}

static bool is_photo(const img_folder *f, const img_folder_file *file)
{
    return img_folder_is_photo(file) && !img_folder_is_beside_raw(f, file) && !is_texture(f, file);
}

static bool is_used(const merlin_photos *photos, const char *mask)
{
    for (size_t i = 0; i < photos->count; i++)
        if (photos->at[i].mask && strcmp(photos->at[i].mask, mask) == 0) return true;
    return false;
}

static const char *reason_of(const img_folder *f, const img_folder_file *file, size_t photos)
{
    if (!file->is_mask) return img_folder_is_beside_raw(f, file) ? "beside a raw picture" : "a mesh's texture";
    if (mask_name_is_whole(file->name) && photos > 1) return "a mask, but of which photograph? Call it NAME.mask.png";
    for (size_t i = 0; i < f->count; i++)
        if (is_photo(f, &f->at[i]) && mask_name_rank(file->name, f->at[i].name, false))
            return "a mask, but another is taken";
    return "a mask, but without its photograph";
}

static status list_skipped(const img_folder *f, merlin_photos *photos)
{
    status s = OK;
    for (size_t i = 0; i < f->count && s == OK; i++) {
        const img_folder_file *file = &f->at[i];
        if (is_photo(f, file) || (file->is_mask && is_used(photos, file->path))) continue;
        s = img_folder_skip(file, reason_of(f, file, photos->count), false, &photos->skipped);
    }
    return s;
}

/* Returns the length of the first part of a path below a folder, with its slash; 0 for files in the folder itself. */
static size_t below(const char *path, const char *folder, const char **name)
{
    *name = path + strlen(folder);
    *name += strspn(*name, "/");
    const char *slash = strchr(*name, '/');
    return slash ? (size_t)(slash - *name) + 1 : 0;
}

/* Adds its subfolders that contain pictures, but not earlier maps or the masks. */
static status list_folders(const char *folder, const char *masks, skipped_files *skipped)
{
    static const char *const endings[] = {IMAGE_ENDINGS, NULL};
    char **paths, last[NAME_MAX + 2] = "";
    size_t count;
    status s = file_list_deep(folder, endings, &paths, &count);
    if (s != OK) return s;
    for (size_t i = 0; i < count && s == OK; i++) {
        const char *name;
        size_t length = below(paths[i], folder, &name);
        if (length == 0 || length >= sizeof last || strncmp(name, last, length) == 0) continue;
        snprintf(last, sizeof last, "%.*s", (int)length, name);
        char *inner = file_folder_of(paths[i]);
        if (!inner) s = no_memory();
        if (inner && !file_is_in(inner, "maps.exr") && !(masks && file_is_same(inner, masks)))
            s = skipped_add(skipped, last, "a folder of its own");
        free(inner);
    }
    file_list_free(paths, count);
    return s;
}

static status add_photos(const img_folder *f, merlin_photos *photos)
{
    photos->at = calloc(f->count + 1, sizeof *photos->at);
    status s = photos->at ? OK : no_memory();
    for (size_t i = 0; i < f->count && s == OK; i++) {
        if (!is_photo(f, &f->at[i])) continue;
        merlin_photo_file *added = &photos->at[photos->count++];
        const img_folder_file *mask = img_folder_mask_of(f, f->at[i].name, false);
        s = copy_path(f->at[i].path, &added->path);
        if (s == OK && mask) s = copy_path(mask->path, &added->mask);
    }
    bool alone = s == OK && photos->count == 1 && !photos->at[0].mask;
    const img_folder_file *whole = alone ? img_folder_whole_mask(f) : NULL;
    return whole ? copy_path(whole->path, &photos->at[0].mask) : s;
}

static status refuse_empty(const char *folder, const skipped_files *skipped)
{
    char left[512];
    skipped_words(skipped, left, sizeof left);
    return fail(MERLIN_BAD_INPUT, "no photographs in the folder %s%s%s", folder, *left ? ": " : "", left);
}

merlin_status merlin_photos_list(const char *folder, const char *masks, merlin_photos *out)
{
    if (out) *out = (merlin_photos){.count = 0};
    status s = api_needs(__func__, folder && out);
    img_folder f;
    bool results;
    if (s == OK) s = read_folder(folder, &f, &results);
    if (s != OK) return s;
    s = add_photos(&f, out);
    if (s == OK) s = list_skipped(&f, out);
    if (s == OK) s = list_folders(folder, masks, &out->skipped);
    if (s == OK && out->count == 0 && !results) s = refuse_empty(folder, &out->skipped);
    img_folder_free(&f);
    if (s != OK) merlin_photos_free(out);
    return s;
}

void merlin_photos_free(merlin_photos *photos)
{
    if (!photos) return;
    for (size_t i = 0; i < photos->count; i++) {
        free(photos->at[i].path);
        free(photos->at[i].mask);
    }
    free(photos->at);
    skipped_free(&photos->skipped);
    *photos = (merlin_photos){.count = 0};
}

/* ---- masks of photographs that are named ---- */

merlin_status merlin_mask_find(const char *photo, char **mask)
{
    if (mask) *mask = NULL;
    status s = api_needs(__func__, photo && mask);
    return s == OK ? img_folder_find_own_mask(photo, mask) : s;
}

int merlin_mask_is_name(const char *name)
{
    return name && mask_name_has_word(name);
}

/* Removes photographs from a folder that also contains masks, as a photograph must not become another one's mask. */
static void leave_photos_out(const char *const *photos, size_t count, const char *folder, img_folder *f)
{
    for (size_t i = 0; i < count; i++) {
        char *of = file_folder_of(photos[i]);
        if (of && file_is_same(of, folder))
            for (size_t k = 0; k < f->count; k++)
                if (strcmp(f->at[k].name, file_name_of(photos[i])) == 0) f->at[k].is_picture = false;
        free(of);
    }
}

static status refuse_maskless(const char *photo, const char *folder)
{
    char names[512];
    mask_names_list(file_name_of(photo), true, names, sizeof names);
    return fail(MERLIN_BAD_INPUT,
                "no mask for %s in %s: looked for %s and the like, of any picture's kind, in any case", photo, folder,
                names);
}

merlin_status merlin_masks_find(const char *folder, const char *const *photos, size_t count, char **masks)
{
    img_folder f;
    status s = api_needs(__func__, folder && ((photos && masks) || count == 0));
    for (size_t i = 0; i < count && s == OK; i++)
        masks[i] = NULL;
    if (s == OK) s = img_folder_read(folder, &f);
    if (s != OK) return s;
    leave_photos_out(photos, count, folder, &f);
    for (size_t i = 0; i < count && s == OK; i++) {
        const img_folder_file *mask = img_folder_mask_of(&f, file_name_of(photos[i]), true);
        if (!mask && count == 1) mask = img_folder_whole_mask(&f);
        s = mask ? copy_path(mask->path, &masks[i]) : refuse_maskless(photos[i], folder);
    }
    for (size_t i = 0; i < count && s != OK; i++) {
        free(masks[i]);
        masks[i] = NULL;
    }
    img_folder_free(&f);
    return s;
}
