/* SPDX-License-Identifier: MIT */
/* Determines which files of a folder are a capture's pictures. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "image/read/folder.h"
#include "image/read/read.h"
#include "stereo/capture/capture_parts.h"

/* Classes of a capture's pictures; a class is used only if there are none of those before it, as telephones write .jpg
 * and .heic side by side. Raw files come before pictures that cameras process, and after pictures that a person has
 * processed, if these are complete. */
typedef enum picture_class { RAW, USUAL, RARE, CLASSES } picture_class;

static bool has_stem(const char *name, const char *stem)
{
    size_t n = strlen(stem);
    return strncasecmp(name, stem, n) == 0 && name[n] == '.';
}

static bool is_beside_the_capture(const char *name)
{
    static const char *const others[] = {"ambient",    "normal", "normals",     "normal_gt", "albedo",        "depth",
                                         "relit",      "orbit",  "calibration", "roughness", "overview",      "error",
                                         "confidence", "mesh",   "maps",        "mask",      "reconstruction"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (has_stem(name, others[i])) return true;
    return false;
}

static bool is_numbered(const char *name)
{
    size_t digits = strspn(name, "0123456789");
    return digits > 0 && name[digits] == '.';
}

static picture_class class_of(const img_folder_file *file)
{
    static const char *const rare[] = {".webp", ".heic", ".heif", ".avif", ".hdr", NULL};
    picture_kind kind = file->format.kind;
    if (file->is_raw) return RAW;
    if (kind == PICTURE_PNG || kind == PICTURE_JPEG || kind == PICTURE_TIFF || kind == PICTURE_EXR) return USUAL;
    return kind == PICTURE_UNKNOWN && !file_ends_in_any(file->name, rare) ? USUAL : RARE;
}

/* Tells whether a person may have processed it in a format that preserves measurements. */
static bool is_developed(const img_folder_file *file)
{
    static const char *const by_camera[] = {IMAGE_CAMERA_ENDINGS, NULL};
    return class_of(file) == USUAL && file->format.kind != PICTURE_JPEG && !file_ends_in_any(file->name, by_camera);
}

static bool may_be_taken(const img_folder_file *file, bool numbered)
{
    return img_folder_is_photo(file) && !is_beside_the_capture(file->name) && (!numbered || is_numbered(file->name));
}

static const char *const other_kind = "of another kind than the pictures that are taken";

/* Fails and names the first subfolder with pictures, if there is one. */
static status refuse_empty(const char *folder, bool numbered, const skipped_files *skipped)
{
    static const char *const endings[] = {IMAGE_ENDINGS, NULL};
    char **names, left[256];
    size_t count;
    status s = file_list_deep(folder, endings, &names, &count);
    if (s != OK) return s;
    skipped_words(skipped, left, sizeof left);
    char *below = NULL, *slash = NULL;
    for (size_t i = 0; i < count && !slash; i++) {
        below = names[i] + strlen(folder);
        below += strspn(below, "/");
        slash = strchr(below, '/');
    }
    if (slash && !numbered)
        s = fail(MERLIN_BAD_INPUT, "no pictures in %s itself; name one of the folders in it, such as %.*s", folder,
                 (int)(slash - below), below);
    else
        s = fail(MERLIN_BAD_INPUT,
                 "no pictures in %s: expected %sPNG, JPEG, TIFF, EXR, WebP, HEIC, HDR or raw files%s%s", folder,
                 numbered ? "01.png, 02.png and on, " : "", *left ? "; " : "", left);
    file_list_free(names, count);
    return s;
}

static status refuse_all(const char *folder, bool numbered, const img_folder *f)
{
    skipped_files skipped = {0};
    status s = OK;
    for (size_t i = 0; i < f->count && s == OK; i++)
        if (!may_be_taken(&f->at[i], false) && !f->at[i].is_mask && !is_beside_the_capture(f->at[i].name))
            s = img_folder_skip(&f->at[i], "no picture", true, &skipped);
    if (s == OK) s = refuse_empty(folder, numbered, &skipped);
    skipped_free(&skipped);
    return s;
}

/* Returns the class whose pictures are used; CLASSES if there are none. */
static picture_class choose_class(const img_folder *f, bool numbered)
{
    size_t count[CLASSES] = {0}, developed = 0;
    for (size_t i = 0; i < f->count; i++) {
        if (!may_be_taken(&f->at[i], numbered)) continue;
        count[class_of(&f->at[i])]++;
        developed += is_developed(&f->at[i]);
    }
    if (count[RAW] > developed) return RAW;
    return count[USUAL] ? USUAL : count[RARE] ? RARE : CLASSES;
}

static bool is_one_of(const char *path, const char *mask, const char *ambient)
{
    return (mask && file_is_same(path, mask)) || (ambient && file_is_same(path, ambient));
}

/* Makes masks, which are not taken, of the files that the options name. */
static void set_aside(const merlin_capture_files *options, img_folder *f)
{
    for (size_t i = 0; i < f->count; i++)
        if (is_one_of(f->at[i].path, options->mask, options->ambient)) f->at[i].is_mask = true;
}

/* Moves the pictures of one class to the front, in no order; *count: their number. */
static status list_pictures(const char *folder, bool numbered, const merlin_capture_files *options, img_folder *f,
                            size_t *count)
{
    *count = 0;
    status s = img_folder_read(folder, f);
    if (s != OK) return s;
    set_aside(options, f);
    picture_class taken = choose_class(f, numbered);
    for (size_t i = 0; i < f->count; i++) {
        if (!may_be_taken(&f->at[i], numbered) || class_of(&f->at[i]) != taken) continue;
        img_folder_file moved = f->at[i];
        f->at[i] = f->at[*count];
        f->at[(*count)++] = moved;
    }
    if (*count == 0) s = refuse_all(folder, numbered, f);
    if (s != OK) img_folder_free(f);
    return s;
}

status pst_check_pictures(const char *folder, const merlin_capture_files *options)
{
    img_folder f;
    size_t count;
    status s = list_pictures(folder, false, options, &f, &count);
    if (s == OK) img_folder_free(&f);
    return s;
}

static bool ends_as(const char *name, const char *other)
{
    const char *dot = strrchr(other, '.');
    return dot && file_ends_in(name, dot);
}

status pst_find_ambient(const char *folder, const char *picture, char **path)
{
    img_folder f;
    const img_folder_file *found = NULL;
    *path = NULL;
    status s = img_folder_read(folder, &f);
    if (s != OK) return s;
    for (size_t i = 0; i < f.count; i++)
        if (img_folder_is_photo(&f.at[i]) && has_stem(f.at[i].name, "ambient") &&
            (!found || ends_as(f.at[i].name, picture)))
            found = &f.at[i];
    if (found && !(*path = strdup(found->path))) s = fail(MERLIN_NO_MEMORY, "no memory for a file name");
    img_folder_free(&f);
    return s;
}

/* Fails as there is another number of lights than of pictures, the first `count` files, and names the others that are
 * not taken for some. */
static status refuse_count(const char *folder, bool numbered, const img_folder *f, size_t count, const char *lights,
                           size_t wanted)
{
    skipped_files skipped = {0};
    char left[256];
    status s = OK;
    for (size_t i = count; i < f->count && s == OK; i++)
        if (may_be_taken(&f->at[i], numbered)) s = img_folder_skip(&f->at[i], other_kind, true, &skipped);
    skipped_words(&skipped, left, sizeof left);
    skipped_free(&skipped);
    if (s != OK) return s;
    return fail(MERLIN_BAD_INPUT, "%s has %zu %spicture%s, but %s has %zu light%s; each picture needs one%s%s", folder,
                count, numbered ? "numbered " : "", count == 1 ? "" : "s", lights, wanted, wanted == 1 ? "" : "s",
                *left ? "; " : "", left);
}

status pst_take_pictures(const char *folder, bool numbered, const merlin_capture_files *options, const char *lights,
                         size_t wanted, merlin_capture *c)
{
    img_folder f;
    size_t count;
    status s = list_pictures(folder, numbered, options, &f, &count);
    if (s != OK) return s;
    if (lights && count != wanted) s = refuse_count(folder, numbered, &f, count, lights, wanted);
    if (s == OK) s = pst_capture_reserve(c, count);
    for (size_t i = 0; i < count && s == OK; i++)
        s = pst_capture_set_name(c, i, f.at[i].name);
    img_folder_free(&f);
    return s;
}

/* ---- skipped files ---- */

static bool is_picture_of(const merlin_capture *c, const char *name)
{
    for (int i = 0; i < c->count; i++)
        if (strcmp(c->name[i], name) == 0) return true;
    return false;
}

/* Returns the reason why a picture does not belong to the capture, whose pictures are of class `taken`. */
static const char *reason_of(const img_folder *f, const img_folder_file *file, picture_class taken)
{
    if (file->is_mask) return "a mask, but another is taken";
    if (taken == RAW && img_folder_is_beside_raw(f, file)) return "beside a raw picture";
    return class_of(file) == taken ? "not listed" : other_kind;
}

static picture_class class_taken(const img_folder *f, const merlin_capture *c)
{
    for (size_t i = 0; i < f->count; i++)
        if (f->at[i].is_picture && strcmp(f->at[i].name, c->name[0]) == 0) return class_of(&f->at[i]);
    return CLASSES;
}

status pst_list_skipped(const char *folder, const char *mask, const char *ambient, merlin_capture *c)
{
    img_folder f;
    status s = img_folder_read(folder, &f);
    if (s != OK) return s;
    picture_class taken = class_taken(&f, c);
    for (size_t i = 0; i < f.count && s == OK; i++) {
        const img_folder_file *file = &f.at[i];
        bool other = file->is_picture && !file->is_mask && is_beside_the_capture(file->name);
        const bool used = is_one_of(file->path, mask, ambient);
        if (used || other || is_picture_of(c, file->name)) continue;
        s = img_folder_skip(file, reason_of(&f, file, taken), true, &c->skipped);
    }
    img_folder_free(&f);
    return s;
}
