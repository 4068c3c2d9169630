#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/memory.h"
#include "image/read.h"
#include "stereo/capture_parts.h"

/* Endings of a capture's pictures, and of those that are taken where there are none of the first: telephones leave
 * .jpg and .heic side by side. */
static const char *const PICTURES[] = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr", NULL};
static const char *const OTHERS[] = {".webp", ".heic", ".heif", ".avif", ".hdr", NULL};

/* Unclipped floats are stored so that their brightest stays below what solvers take for saturated. */
static const float FLOAT_CEILING = 0.97f;

/* Floats that are all below have a full scale of their own: in 16 bits dim ones would be a few codes, and black. */
static const float FLOAT_DIM = 0.1f;

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
    status s = file_list_deep(folder, PICTURES, &names, &count);
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
        s = fail(ERROR_INPUT, "no pictures in %s: expected %sPNG, JPEG, TIFF, EXR, WebP, HEIC or HDR files", folder,
                 numbered ? "01.png, 02.png and on, " : "");
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
        char *path = (*names)[i], *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
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

static status list_pictures(const char *folder, bool numbered, char ***names, size_t *count)
{
    status s = list_kinds(folder, PICTURES, numbered, names, count);
    if (s == OK && *count == 0) s = list_kinds(folder, OTHERS, numbered, names, count);
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

typedef struct reading {
    const char *folder;
    bool decode;
    float scale; /* of floats, so that all pictures fit 16 bits */
    img ambient;
} reading;

static status read_one(const reading *r, const char *name, img *out, int *bits)
{
    char *path = file_join(r->folder, name);
    if (!path) return fail(ERROR_MEMORY, "no memory for a file name");
    status s = img_read_samples(path, r->decode, out, bits);
    free(path);
    return s;
}

static status check_shape(const reading *r, const pst_capture *c, const char *name, const img *picture)
{
    if (picture->width != c->width || picture->height != c->height)
        return fail(ERROR_INPUT, "%s/%s is %d x %d pixels, but %s is %d x %d; all pictures must have one size",
                    r->folder, name, picture->width, picture->height, c->name[0], c->width, c->height);
    if (picture->channels != c->channels)
        return fail(ERROR_INPUT, "%s/%s is %s, but %s is %s; all pictures must be of one kind", r->folder, name,
                    picture->channels == 1 ? "grey" : "in colour", c->name[0], c->channels == 1 ? "grey" : "in colour");
    return OK;
}

static status store(const reading *r, const img *picture, int bits, uint16_t **out)
{
    size_t count = (size_t)picture->width * (size_t)picture->height * (size_t)picture->channels;
    uint16_t *codes = malloc(count * sizeof *codes);
    if (!codes) return fail(ERROR_MEMORY, "no memory for a picture of %d x %d pixels", picture->width, picture->height);
    memory_prefer_large_pages(codes, count * sizeof *codes);
    const float *ambient = r->ambient.data;
    float scale = bits == 32 ? r->scale : 1;
    for (size_t i = 0; i < count; i++) {
        float value = picture->data[i] * scale;
        /* what the sensor clipped stays recognizable after the subtraction */
        bool clipped = value >= 1;
        if (ambient) value -= ambient[i];
        codes[i] = clipped ? 65535 : (uint16_t)lroundf(fminf(fmaxf(value, 0), 1) * 65535);
    }
    *out = codes;
    return OK;
}

/* The factor that brings the brightest float of all pictures to the ceiling; 1 if they fit and are not dim. Reads only
 * floats. */
static status measure_scale(reading *r, const pst_capture *c)
{
    float most = 0;
    for (int i = 0; i < c->count; i++) {
        img picture;
        int bits;
        status s = read_one(r, c->name[i], &picture, &bits);
        if (s != OK) return s;
        size_t count = (size_t)picture.width * (size_t)picture.height * (size_t)picture.channels;
        for (size_t k = 0; k < count && bits == 32; k++)
            most = fmaxf(most, picture.data[k]);
        img_free(&picture);
        if (bits != 32) break;
    }
    r->scale = most > FLOAT_CEILING || (most > 0 && most < FLOAT_DIM) ? FLOAT_CEILING / most : 1;
    return OK;
}

static status read_first_shape(reading *r, pst_capture *c)
{
    img first;
    int bits;
    status s = read_one(r, c->name[0], &first, &bits);
    if (s != OK) return s;
    status fits = OK;
    if (c->width && (c->width != first.width || c->height != first.height))
        fits = fail(ERROR_INPUT, "%s/%s is %d x %d pixels, but the lights' file says %d x %d", r->folder, c->name[0],
                    first.width, first.height, c->width, c->height);
    c->width = first.width;
    c->height = first.height;
    c->channels = first.channels;
    img_free(&first);
    if (fits != OK) return fits;
    return bits == 32 ? measure_scale(r, c) : OK;
}

static status read_ambient(reading *r, const char *asked, const pst_capture *c)
{
    char *path = asked ? strdup(asked) : file_join(r->folder, "ambient.png");
    if (!path) return fail(ERROR_MEMORY, "no memory for a file name");
    status s = OK;
    int bits;
    if (asked || file_exists(path)) {
        s = img_read_samples(path, r->decode, &r->ambient, &bits);
        if (s == OK &&
            (r->ambient.width != c->width || r->ambient.height != c->height || r->ambient.channels != c->channels))
            s = fail(ERROR_INPUT,
                     "the ambient picture %s is %d x %d with %d channels, but the pictures are %d x %d with %d", path,
                     r->ambient.width, r->ambient.height, r->ambient.channels, c->width, c->height, c->channels);
        size_t count = s == OK ? (size_t)c->width * (size_t)c->height * (size_t)c->channels : 0;
        for (size_t i = 0; i < count && bits == 32; i++)
            r->ambient.data[i] *= r->scale;
    }
    free(path);
    return s;
}

status pst_read_pictures(const char *folder, const pst_read_options *options, pst_capture *c)
{
    reading r = {.folder = folder, .decode = !options->linear, .scale = 1};
    status s = read_first_shape(&r, c);
    if (s == OK) s = read_ambient(&r, options->ambient, c);
    for (int i = 0; i < c->count && s == OK; i++) {
        img picture;
        int bits;
        s = read_one(&r, c->name[i], &picture, &bits);
        if (s != OK) break;
        s = check_shape(&r, c, c->name[i], &picture);
        if (s == OK) s = store(&r, &picture, bits, &c->picture[i]);
        img_free(&picture);
    }
    img_free(&r.ambient);
    return s;
}
