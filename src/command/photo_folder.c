/* SPDX-License-Identifier: MIT */
#include "command/photo_folder.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "command/standard_input.h"
#include "image/read/folder.h"
#include "image/read/mask_names.h"
#include "image/read/read.h"

/* Tells whether estimate and stereo write a file of this name with maps.exr. */
static bool is_result_name(const char *name)
{
    static const char *const results[] = {"albedo.png",         "depth.png",     "error.png",   "maps.exr",
                                          "mask.png",           "mesh.png",      "normal.png",  "overview.png",
                                          "reconstruction.png", "roughness.png", "report.json", "mesh.glb",
                                          "mesh.obj",           "mesh.mtl",      "mesh.ply"};
    for (size_t i = 0; i < sizeof results / sizeof results[0]; i++)
        if (strcmp(name, results[i]) == 0) return true;
    return false;
}

static status no_memory(void)
{
    return fail(MERLIN_NO_MEMORY, "no memory for file names");
}

status photo_list_add(photo_list *list, const char *photo)
{
    photo_job *larger = realloc(list->at, (list->count + 1) * sizeof *larger);
    if (!larger) return no_memory();
    list->at = larger;
    list->at[list->count] = (photo_job){.photo = strdup(photo)};
    return list->at[list->count++].photo ? OK : no_memory();
}

static status set_mask(photo_job *job, const char *mask)
{
    char *copy = strdup(mask);
    if (!copy) return no_memory();
    free(job->mask);
    job->mask = copy;
    return OK;
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

/* Tells whether a picture is the texture of an OBJ named by --mesh. */
static bool is_texture(const img_folder *f, const img_folder_file *file)
{
    size_t stem = strlen(file->name) - strlen(".png");
    for (size_t i = 0; i < f->count && file_ends_in(file->name, ".png"); i++)
        if (file_ends_in(f->at[i].name, ".mtl") && strncmp(f->at[i].name, file->name, stem + 1) == 0) return true;
    return false;
}

static bool is_photo(const img_folder *f, const img_folder_file *file)
{
    return img_folder_is_photo(file) && !img_folder_is_beside_raw(f, file) && !is_texture(f, file);
}

static bool is_used(const photo_list *list, size_t first, const char *mask)
{
    for (size_t i = first; i < list->count; i++)
        if (list->at[i].mask && strcmp(list->at[i].mask, mask) == 0) return true;
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

/* Lists skipped files; first: index of the folder's first photograph in the list. */
static status list_skipped(const photo_list *list, size_t first, const img_folder *f, skipped_files *skipped)
{
    status s = OK;
    size_t photos = list->count - first;
    for (size_t i = 0; i < f->count && s == OK; i++) {
        const img_folder_file *file = &f->at[i];
        if (is_photo(f, file) || (file->is_mask && is_used(list, first, file->path))) continue;
        s = img_folder_skip(file, reason_of(f, file, photos), false, skipped);
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

static status add_photos(photo_list *list, const img_folder *f)
{
    size_t first = list->count;
    status s = OK;
    for (size_t i = 0; i < f->count && s == OK; i++) {
        if (!is_photo(f, &f->at[i])) continue;
        s = photo_list_add(list, f->at[i].path);
        if (s != OK) return s;
        const img_folder_file *mask = img_folder_mask_of(f, f->at[i].name, false);
        if (mask) s = set_mask(&list->at[list->count - 1], mask->path);
    }
    bool alone = s == OK && list->count == first + 1 && !list->at[first].mask;
    const img_folder_file *whole = alone ? img_folder_whole_mask(f) : NULL;
    return whole ? set_mask(&list->at[first], whole->path) : s;
}

static status refuse_empty(const char *folder, const skipped_files *skipped)
{
    char left[512];
    skipped_words(skipped, left, sizeof left);
    return fail(MERLIN_BAD_INPUT, "no photographs in the folder %s%s%s", folder, *left ? ": " : "", left);
}

static status add_to_folders(photo_list *list, const char *folder, skipped_files *skipped)
{
    photo_folder *larger = realloc(list->folder, (list->folders + 1) * sizeof *larger);
    if (!larger) return no_memory();
    list->folder = larger;
    photo_folder *added = &larger[list->folders];
    *added = (photo_folder){.path = strdup(folder)};
    if (!added->path) return no_memory();
    list->folders++;
    return skipped_append(&added->skipped, skipped);
}

status photo_folder_add(photo_list *list, const char *folder, const char *masks)
{
    img_folder f;
    bool results;
    size_t first = list->count;
    skipped_files skipped = {0};
    status s = read_folder(folder, &f, &results);
    if (s != OK) return s;
    s = add_photos(list, &f);
    if (s == OK) s = list_skipped(list, first, &f, &skipped);
    if (s == OK) s = list_folders(folder, masks, &skipped);
    if (s == OK && list->count == first && !results) s = refuse_empty(folder, &skipped);
    if (s == OK) s = add_to_folders(list, folder, &skipped);
    skipped_free(&skipped);
    img_folder_free(&f);
    return s;
}

/* ---- masks of photographs that are named ---- */

status photo_own_mask(const char *photo, char **mask)
{
    *mask = NULL;
    return standard_input_is(photo) ? OK : img_folder_find_own_mask(photo, mask);
}

static bool is_mask_of_other(const photo_list *list, size_t i)
{
    for (size_t k = 0; k < list->count; k++)
        if (k != i && list->at[k].mask && file_is_same(list->at[k].mask, list->at[i].photo)) return true;
    return false;
}

void photo_list_drop_masks(photo_list *list)
{
    for (size_t i = 0; i < list->count;) {
        photo_job *job = &list->at[i];
        if (!mask_name_has_word(file_name_of(job->photo)) || !is_mask_of_other(list, i)) {
            i++;
            continue;
        }
        free(job->photo);
        free(job->mask);
        memmove(job, job + 1, (--list->count - i) * sizeof *job);
    }
}

/* ---- a folder of masks ---- */

/* Removes photographs from a folder that also contains masks, as a photograph must not become another one's mask. */
static void leave_photos_out(const photo_list *list, const char *folder, img_folder *f)
{
    for (size_t i = 0; i < list->count; i++) {
        char *of = file_folder_of(list->at[i].photo);
        if (of && file_is_same(of, folder))
            for (size_t k = 0; k < f->count; k++)
                if (strcmp(f->at[k].name, file_name_of(list->at[i].photo)) == 0) f->at[k].is_picture = false;
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

status photo_folder_find_masks(photo_list *list, const char *folder)
{
    img_folder f;
    status s = img_folder_read(folder, &f);
    if (s != OK) return s;
    leave_photos_out(list, folder, &f);
    for (size_t i = 0; i < list->count && s == OK; i++) {
        photo_job *job = &list->at[i];
        const img_folder_file *mask = img_folder_mask_of(&f, file_name_of(job->photo), true);
        if (!mask && list->count == 1) mask = img_folder_whole_mask(&f);
        s = mask ? set_mask(job, mask->path) : refuse_maskless(job->photo, folder);
    }
    img_folder_free(&f);
    return s;
}
