/* SPDX-License-Identifier: MIT */
#include "image/read/folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/text/text.h"
#include "image/metadata/byte_source.h"
#include "image/read/mask_look.h"
#include "image/read/mask_names.h"
#include "image/read/read.h"

static const char *const named_as_pictures[] = {IMAGE_ENDINGS, NULL};
static const char *const named_as_raw[] = {IMAGE_RAW_ENDINGS, NULL};
static const char *const named_by_cameras[] = {IMAGE_CAMERA_ENDINGS, NULL};

/* Endings of files with picture content that are no photographs: Canon's thumbnails, and backup copies. */
static const char *const copies[] = {".thm", ".bak", ".tmp", ".part", ".crdownload", "~", NULL};

/* Endings of side-car files that programs keep beside a picture. */
static const char *const notes[] = {".xmp", ".aae", ".pp3", ".dop", ".thm", ".cos", ".arp", NULL};

/* Endings of data, other than text, that a capture is read from, or that results from one. */
static const char *const data[] = {".mat", ".npz", ".npy", ".ply", ".glb", NULL};

static bool is_left_by_systems(const char *name)
{
    static const char *const names[] = {"thumbs.db", "ehthumbs.db", "desktop.ini", "picasa.ini", "icon\r"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcasecmp(name, names[i]) == 0) return true;
    return false;
}

static img_folder_file look_at(char *path)
{
    img_folder_file f = {.path = path, .name = file_name_of(path)};
    if (file_ends_in_any(f.name, copies)) return f;
    f.format = img_format_of(path);
    f.is_picture = f.format.is_read || (!f.format.name && file_ends_in_any(f.name, named_as_pictures));
    f.is_raw = f.is_picture && (f.format.kind == PICTURE_RAW || file_ends_in_any(f.name, named_as_raw));
    return f;
}

/* Finds a photograph's mask by name. It compares names before it opens files, as it is called for each of many
 * photographs. */
static const char *find_by_name(char *const *names, size_t count, const char *photo)
{
    const char *best = NULL;
    int least = 0;
    for (size_t i = 0; i < count; i++) {
        const char *name = file_name_of(names[i]);
        int rank = mask_name_has_word(name) ? mask_name_rank(name, photo, false) : 0;
        if (rank == 0 || (best && rank >= least) || !look_at(names[i]).is_picture) continue;
        best = name;
        least = rank;
    }
    return best;
}

status img_folder_find_own_mask(const char *photo, char **mask)
{
    char **names, *folder = file_folder_of(photo);
    size_t count;
    *mask = NULL;
    if (!folder) return fail(MERLIN_NO_MEMORY, "no memory for file names");
    status s = file_list(folder, NULL, &names, &count);
    if (s == OK) {
        const char *found = find_by_name(names, count, file_name_of(photo));
        if (found) /* with the photograph's own spelling of the folder */
            *mask = strchr(photo, '/') ? file_join(folder, found) : strdup(found);
        if (found && !*mask) s = fail(MERLIN_NO_MEMORY, "no memory for file names");
        file_list_free(names, count);
    }
    free(folder);
    return s == MERLIN_NO_MEMORY ? s : OK; /* a folder may be unreadable whose files are not */
}

/* Tells whether the photograph of this mask's name is in the folder. */
static bool has_photo(const img_folder *f, const img_folder_file *mask)
{
    for (size_t i = 0; i < f->count; i++)
        if (f->at[i].is_picture && mask_name_rank(mask->name, f->at[i].name, false)) return true;
    return false;
}

static status look_for_mask(const img_folder *f, img_folder_file *file)
{
    if (!file->is_picture || !mask_name_has_word(file->name)) return OK;
    file->is_mask = mask_name_is_whole(file->name) || mask_name_is_sure(file->name) || has_photo(f, file);
    return file->is_mask || !mask_name_is_likely(file->name) ? OK : mask_look(file->path, &file->is_mask);
}

status img_folder_read(const char *folder, img_folder *out)
{
    char **names;
    size_t count;
    *out = (img_folder){0};
    status s = file_list(folder, NULL, &names, &count);
    if (s != OK) return s;
    out->at = calloc(count + 1, sizeof *out->at);
    if (!out->at) {
        file_list_free(names, count);
        return fail(MERLIN_NO_MEMORY, "no memory for the names in %s", folder);
    }
    for (size_t i = 0; i < count; i++)
        if (is_left_by_systems(file_name_of(names[i])))
            free(names[i]);
        else
            out->at[out->count++] = look_at(names[i]);
    free(names);
    for (size_t i = 0; s == OK && i < out->count; i++)
        s = look_for_mask(out, &out->at[i]);
    if (s != OK) img_folder_free(out);
    return s;
}

void img_folder_free(img_folder *f)
{
    for (size_t i = 0; i < f->count; i++)
        free(f->at[i].path);
    free(f->at);
    *f = (img_folder){0};
}

bool img_folder_is_photo(const img_folder_file *file)
{
    return file->is_picture && !file->is_mask;
}

static size_t stem_length(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && dot > name ? (size_t)(dot - name) : strlen(name);
}

bool img_folder_is_beside_raw(const img_folder *f, const img_folder_file *file)
{
    picture_kind kind = file->format.kind;
    bool developed = kind == PICTURE_JPEG || kind == PICTURE_HEIC || file_ends_in_any(file->name, named_by_cameras);
    if (file->is_raw || !developed) return false;
    size_t stem = stem_length(file->name);
    for (size_t i = 0; i < f->count; i++)
        if (f->at[i].is_raw && stem_length(f->at[i].name) == stem && strncasecmp(f->at[i].name, file->name, stem) == 0)
            return true;
    return false;
}

const img_folder_file *img_folder_mask_of(const img_folder *f, const char *photo, bool apart)
{
    const img_folder_file *best = NULL;
    int least = 0;
    for (size_t i = 0; i < f->count; i++) {
        const img_folder_file *file = &f->at[i];
        int rank = apart || file->is_mask ? mask_name_rank(file->name, photo, apart) : 0;
        if (!file->is_picture || rank == 0 || (best && rank >= least)) continue;
        best = file;
        least = rank;
    }
    return best;
}

const img_folder_file *img_folder_whole_mask(const img_folder *f)
{
    const img_folder_file *best = NULL;
    int least = 0;
    for (size_t i = 0; i < f->count; i++) {
        const img_folder_file *file = &f->at[i];
        if (!file->is_mask) continue;
        bool whole = mask_name_is_whole(file->name), own = !whole && has_photo(f, file);
        int rank = whole ? 1 : own ? 5 : 3;
        rank += !file_ends_in(file->name, ".png");
        if (best && rank >= least) continue;
        best = file;
        least = rank;
    }
    return best;
}

static status look_for_text(const char *path, bool *is_text)
{
    static const char blanks[] = {'\t', '\n', '\f', '\r'};
    char head[IMG_FORMAT_HEAD], *text = NULL;
    byte_source file;
    *is_text = false;
    if (!byte_source_open(&file, path)) return OK;
    size_t size = byte_source_read(&file, 0, head, sizeof head);
    byte_source_close(&file);
    status s = text_decode(head, size, path, &text);
    *is_text = s == OK;
    for (const char *c = text; *is_text && *c; c++)
        *is_text = (unsigned char)*c >= ' ' || memchr(blanks, *c, sizeof blanks);
    free(text);
    return s == MERLIN_NO_MEMORY ? s : OK;
}

/* Tells whether a file usually accompanies pictures, so that skipping it is not reported. */
static status look_beside(const img_folder_file *file, bool capture, bool *is_beside)
{
    *is_beside = !file->is_picture && !file->format.name && file_ends_in_any(file->name, notes);
    if (file->is_picture || file->format.name || *is_beside || !capture || file_ends_in_any(file->name, copies))
        return OK;
    *is_beside = file_ends_in_any(file->name, data);
    return *is_beside ? OK : look_for_text(file->path, is_beside);
}

status img_folder_skip(const img_folder_file *file, const char *why, bool capture, skipped_files *list)
{
    char unread[64];
    bool is_beside;
    status s = look_beside(file, capture, &is_beside);
    if (s != OK || is_beside) return s;
    if (!file->is_picture) {
        snprintf(unread, sizeof unread, "%s is not read", file->format.name ? file->format.name : "");
        why = file->format.name ? unread : file_ends_in_any(file->name, copies) ? "a copy" : "no picture";
    }
    return skipped_add(list, file->name, why);
}
