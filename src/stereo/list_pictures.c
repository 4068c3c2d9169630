/* Which files of a folder are a capture's pictures. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "image/read.h"
#include "stereo/capture_parts.h"

/* Endings of a capture's pictures, and of those that are taken where there are none of the first: telephones leave
 * .jpg and .heic side by side. Raw ones come before what cameras develop, and behind what somebody developed, if that
 * is all of them. */
static const char *const PICTURES[] = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr", NULL};
static const char *const DEVELOPED[] = {".png", ".tif", ".tiff", ".exr", NULL};
static const char *const RAWS[] = {IMAGE_RAW_ENDINGS, NULL};
static const char *const ANY[] = {IMAGE_ENDINGS, NULL};
static const char *const OTHERS[] = {".webp", ".heic", ".heif", ".avif", ".hdr", NULL};

static bool has_stem(const char *name, const char *stem)
{
    size_t n = strlen(stem);
    return strncasecmp(name, stem, n) == 0 && name[n] == '.';
}

static bool is_beside_the_capture(const char *name)
{
    static const char *const others[] = {"mask",  "ambient",        "normal", "normals",     "normal_gt", "albedo",
                                         "depth", "relit",          "orbit",  "calibration", "roughness", "overview",
                                         "error", "reconstruction", "mesh",   "maps"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (has_stem(name, others[i])) return true;
    return file_ends_in(name, ".mask.png");
}

static bool is_numbered(const char *name)
{
    size_t digits = strspn(name, "0123456789");
    return digits > 0 && name[digits] == '.';
}

/* Where to look instead: in the first folder below with pictures, if there is one. */
static status refuse_empty(const char *folder, bool numbered)
{
    char **names;
    size_t count;
    status s = file_list_deep(folder, ANY, &names, &count);
    if (s != OK) return s;
    char *below = NULL, *slash = NULL;
    for (size_t i = 0; i < count && !slash; i++) {
        below = names[i] + strlen(folder);
        below += strspn(below, "/");
        slash = strchr(below, '/');
    }
    if (slash && !numbered)
        s = fail(ERROR_INPUT, "no pictures in %s itself; name one of the folders in it, such as %.*s", folder,
                 (int)(slash - below), below);
    else
        s = fail(ERROR_INPUT, "no pictures in %s: expected %sPNG, JPEG, TIFF, EXR, WebP, HEIC, HDR or raw files",
                 folder, numbered ? "01.png, 02.png and on, " : "");
    file_list_free(names, count);
    return s;
}

/* None is no failure; then *names needs no freeing. */
static status list_kinds(const char *folder, const char *const *endings, bool numbered, char ***names, size_t *count)
{
    status s = file_list(folder, endings, names, count);
    if (s != OK) return s;
    size_t kept = 0;
    for (size_t i = 0; i < *count; i++) {
        char *path = (*names)[i];
        const char *name = file_name_of(path);
        if (is_beside_the_capture(name) || (numbered && !is_numbered(name))) {
            free(path);
            continue;
        }
        memmove(path, name, strlen(name) + 1);
        (*names)[kept++] = path;
    }
    *count = kept;
    if (kept) return OK;
    file_list_free(*names, 0);
    *names = NULL;
    return OK;
}

static status count_kinds(const char *folder, const char *const *endings, bool numbered, size_t *count)
{
    char **names;
    status s = list_kinds(folder, endings, numbered, &names, count);
    if (s == OK && *count) file_list_free(names, *count);
    return s;
}

static status list_pictures(const char *folder, bool numbered, char ***names, size_t *count)
{
    static const char *const *const kinds[] = {RAWS, PICTURES, OTHERS};
    size_t developed = 0, raw = 0;
    status s = count_kinds(folder, DEVELOPED, numbered, &developed);
    if (s == OK) s = count_kinds(folder, RAWS, numbered, &raw);
    *count = 0;
    for (int i = raw <= developed; i < 3 && s == OK && *count == 0; i++)
        s = list_kinds(folder, kinds[i], numbered, names, count);
    return s == OK && *count == 0 ? refuse_empty(folder, numbered) : s;
}

status pst_check_pictures(const char *folder)
{
    char **names;
    size_t count;
    status s = list_pictures(folder, false, &names, &count);
    if (s == OK) file_list_free(names, count);
    return s;
}

static bool ends_as(const char *name, const char *other)
{
    const char *dot = strrchr(other, '.');
    return dot && file_ends_in(name, dot);
}

status pst_find_ambient(const char *folder, const char *picture, char **path)
{
    char **names;
    size_t count, found = SIZE_MAX;
    *path = NULL;
    status s = file_list(folder, ANY, &names, &count);
    if (s != OK) return s;
    for (size_t i = 0; i < count; i++) {
        const char *name = file_name_of(names[i]);
        if (has_stem(name, "ambient") && (found == SIZE_MAX || ends_as(name, picture))) found = i;
    }
    if (found != SIZE_MAX && !(*path = strdup(names[found]))) s = fail(ERROR_MEMORY, "no memory for a file name");
    file_list_free(names, count);
    return s;
}

status pst_take_pictures(const char *folder, bool numbered, const char *lights, size_t wanted, pst_capture *c)
{
    char **names;
    size_t count;
    status s = list_pictures(folder, numbered, &names, &count);
    if (s != OK) return s;
    if (lights && count != wanted)
        s = fail(ERROR_INPUT, "%s has %zu %spictures, but %s has %zu lights; each picture needs one", folder, count,
                 numbered ? "numbered " : "", lights, wanted);
    if (s == OK) s = pst_capture_reserve(c, count);
    for (size_t i = 0; i < count && s == OK; i++)
        s = pst_capture_set_name(c, i, names[i]);
    file_list_free(names, count);
    return s;
}
