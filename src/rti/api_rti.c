/* SPDX-License-Identifier: MIT */
/* The functions of merlin/rti.h. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/number.h"
#include "base/parallel.h"
#include "base/staging.h"
#include "image/color.h"
#include "image/write/jpeg.h"
#include "rti/rti_fit.h"
#include "rti/rti_write.h"

/* ---- a new one ---- */

static status check_params(int width, int height, const merlin_rti_params *p)
{
    if (width < 1 || height < 1 || width > MERLIN_RTI_MOST_SIDE || height > MERLIN_RTI_MOST_SIDE)
        return fail(MERLIN_WRONG_USE, "%d x %d pixels are not between 1 and %d a side", width, height,
                    MERLIN_RTI_MOST_SIDE);
    if ((int)p->basis < MERLIN_RTI_PTM || p->basis > MERLIN_RTI_RBF)
        return fail(MERLIN_WRONG_USE, "there is no basis by the number %d", (int)p->basis);
    if (p->planes % 3 || p->planes < 0 || p->planes > MERLIN_RTI_MOST_PLANES)
        return fail(MERLIN_WRONG_USE, "%d planes are not a multiple of 3 up to %d", p->planes, MERLIN_RTI_MOST_PLANES);
    if (p->quality < 0 || p->quality > 100)
        return fail(MERLIN_WRONG_USE, "a quality of %d is not between 1 and 100", p->quality);
    return OK;
}

static status allocate(merlin_rti *r)
{
    const size_t pixels = rti_pixel_count(r), most = MERLIN_RTI_MOST_PICTURES;
    r->direction = calloc(3 * most, sizeof *r->direction);
    if (r->how.basis == MERLIN_RTI_RBF)
        r->pictures = calloc(most, sizeof *r->pictures);
    else
        r->sums = memory_new(pixels * 3 * (size_t)r->terms * sizeof *r->sums);
    if (r->how.basis == MERLIN_RTI_LRGB) r->peak = memory_new(pixels);
    const bool done = r->direction && (r->pictures || r->sums) && (r->how.basis != MERLIN_RTI_LRGB || r->peak);
    return done ? OK : fail(MERLIN_NO_MEMORY, "no memory for the sums of %d x %d pixels", r->width, r->height);
}

merlin_status merlin_rti_new(int width, int height, const merlin_rti_params *params, merlin_rti **out)
{
    const merlin_rti_params how = params ? *params : (merlin_rti_params){0};
    status s = api_needs(__func__, out != NULL);
    if (s != OK) return s;
    *out = NULL;
    s = check_params(width, height, &how);
    if (s != OK) return s;
    merlin_rti *r = calloc(1, sizeof *r);
    if (!r) return fail(MERLIN_NO_MEMORY, "no memory for a picture to be relit");
    *r = (merlin_rti){.width = width, .height = height, .terms = rti_term_count(how.basis), .how = how};
    if (r->how.planes == 0) r->how.planes = MERLIN_RTI_PLANES;
    if (r->how.quality == 0) r->how.quality = MERLIN_RTI_QUALITY;
    s = allocate(r);
    if (s == OK)
        *out = r;
    else
        merlin_rti_free(r);
    return s;
}

void merlin_rti_free(merlin_rti *rti)
{
    if (!rti) return;
    for (int i = 0; rti->pictures && i < rti->count; i++)
        memory_free(rti->pictures[i]);
    free(rti->pictures);
    memory_free(rti->sums);
    memory_free(rti->peak);
    free(rti->direction);
    free(rti);
}

/* ---- pictures ---- */

typedef struct adding {
    merlin_rti *rti;
    const merlin_image *picture;
    float terms[RTI_MOST_TERMS];
} adding;

enum { AT_ONCE = 256 };

static void add_codes(const adding *a, size_t pixel, const uint8_t *rgb)
{
    if (!rgb[0] && !rgb[1] && !rgb[2]) return; /* and memory that was not touched stays so */
    const int n = a->rti->terms;
    float *sums = a->rti->sums + pixel * 3 * (size_t)n;
    for (int k = 0; k < n; k++)
        for (int c = 0; c < 3; c++)
            sums[3 * k + c] += a->terms[k] * (float)rgb[c] / 255;
    for (int c = 0; a->rti->peak && c < 3; c++)
        if (rgb[c] > a->rti->peak[pixel]) a->rti->peak[pixel] = rgb[c];
}

static void add_sums(void *context, size_t begin, size_t end)
{
    const adding *a = context;
    uint8_t codes[3 * AT_ONCE];
    for (size_t first = begin; first < end; first += AT_ONCE) {
        const size_t count = min_size(AT_ONCE, end - first);
        srgb_codes8(a->picture->data + 3 * first, 3 * count, codes);
        for (size_t i = 0; i < count; i++)
            add_codes(a, first + i, codes + 3 * i);
    }
}

static void keep_codes(void *context, size_t begin, size_t end)
{
    const adding *a = context;
    srgb_codes8(a->picture->data + 3 * begin, 3 * (end - begin), a->rti->pictures[a->rti->count] + 3 * begin);
}

static status check_picture(const merlin_rti *rti, const merlin_image *p, const float direction[3])
{
    const bool kept = rti->how.basis == MERLIN_RTI_RBF;
    const int most = kept ? MERLIN_RTI_MOST_RBF_PICTURES : MERLIN_RTI_MOST_PICTURES;
    if (!p->data || p->width != rti->width || p->height != rti->height || p->channels != 3)
        return fail(MERLIN_WRONG_USE, "a picture of %d x %d pixels and %d channels is not one of %d x %d and 3",
                    p->width, p->height, p->channels, rti->width, rti->height);
    const float length = hypotf(hypotf(direction[0], direction[1]), direction[2]);
    if (!isfinite(length) || !(direction[2] > 0))
        return fail(MERLIN_WRONG_USE, "a light in direction %g,%g,%g is not in front of the object: z is above 0",
                    (double)direction[0], (double)direction[1], (double)direction[2]);
    if (rti->count == most)
        return fail(MERLIN_WRONG_USE, "more than %d pictures cannot be added for %s", most,
                    rti_basis_name(rti->how.basis));
    return OK;
}

static status add(merlin_rti *rti, const merlin_image *picture, const float unit[3])
{
    adding a = {.rti = rti, .picture = picture};
    const size_t pixels = rti_pixel_count(rti);
    double terms[RTI_MOST_TERMS];
    if (rti->pictures) {
        rti->pictures[rti->count] = memory_new(3 * pixels);
        if (!rti->pictures[rti->count])
            return fail(MERLIN_NO_MEMORY, "no memory for picture %d of %d x %d pixels", rti->count + 1, rti->width,
                        rti->height);
        parallel_blocks(pixels, keep_codes, &a);
        return OK;
    }
    rti_terms(rti->how.basis, unit, terms);
    for (int k = 0; k < rti->terms; k++) {
        a.terms[k] = (float)terms[k];
        for (int j = 0; j < rti->terms; j++)
            rti->gram[k * rti->terms + j] += terms[k] * terms[j];
    }
    parallel_blocks(pixels, add_sums, &a);
    return OK;
}

merlin_status merlin_rti_add(merlin_rti *rti, const merlin_image *picture, const float direction[3])
{
    status s = api_needs(__func__, rti && picture && direction);
    if (s == OK) s = check_picture(rti, picture, direction);
    if (s != OK) return s;
    const float length = hypotf(hypotf(direction[0], direction[1]), direction[2]);
    float *unit = rti->direction + 3 * (size_t)rti->count;
    for (int k = 0; k < 3; k++)
        unit[k] = direction[k] / length;
    s = add(rti, picture, unit);
    if (s == OK) rti->count++;
    return s;
}

/* ---- files ---- */

/* The codes, and what info.json needs of RBF beside them. */
typedef struct made {
    rti_planes planes;
    rti_components components;
} made;

static status make(const merlin_rti *rti, bool shared, made *out)
{
    rti_fit fit;
    rti_values values;
    *out = (made){0};
    status s = rti->pictures ? rti_components_new(rti, &out->components, &values) : rti_fit_new(rti, &fit, &values);
    values.shared = shared;
    return s == OK ? rti_planes_new(&values, &out->planes) : s;
}

static void made_free(made *m)
{
    rti_planes_free(&m->planes);
    rti_components_free(&m->components);
}

static status write_jpeg(const char *path, const rti_planes *planes, int first, int quality)
{
    const size_t pixels = (size_t)planes->width * (size_t)planes->height;
    uint8_t *rgb = malloc(3 * pixels), *data = NULL;
    size_t size = 0;
    if (!rgb) return fail(MERLIN_NO_MEMORY, "no memory to write %s", path);
    for (size_t i = 0; i < pixels; i++)
        memcpy(rgb + 3 * i, planes->codes + i * (size_t)planes->planes + first, 3);
    status s =
        jpeg_encode_codes(path, rgb, planes->width, planes->height, &(img_jpeg){.quality = quality}, &data, &size);
    if (s == OK) s = file_write(path, data, size);
    free(data);
    free(rgb);
    return s;
}

/* later: whether it replaces an earlier one. */
static status write_all(const merlin_rti *rti, const made *m, bool later, staging *files)
{
    char name[32], path[PATH_MAX];
    const rti_components *components = rti->pictures ? &m->components : NULL;
    status s = rti_write_info(staging_path(files, "info.json", path), rti, &m->planes, components);
    if (s == OK && later) s = staging_drop_numbered(files, "plane_", ".jpg"); /* it may have had more */
    for (int k = 0; k < m->planes.planes / 3 && s == OK; k++) {
        snprintf(name, sizeof name, "plane_%d.jpg", k);
        s = write_jpeg(staging_path(files, name, path), &m->planes, 3 * k, rti->how.quality);
    }
    return s;
}

merlin_status merlin_rti_write(const merlin_rti *rti, const char *folder, merlin_files *written)
{
    made m = {0};
    staging *files;
    if (written) *written = (merlin_files){0};
    status s = api_needs(__func__, rti && folder);
    if (s == OK) s = make(rti, false, &m);
    if (s == OK) s = staging_begin(folder, NULL, &files);
    if (s == OK) {
        s = write_all(rti, &m, file_is_in(folder, "info.json"), files);
        s = s == OK ? staging_commit(files, written) : staging_abort(files, s);
    }
    made_free(&m);
    return s;
}

merlin_status merlin_rti_write_ptm(const merlin_rti *rti, const char *path)
{
    made m = {0};
    status s = api_needs(__func__, rti && path);
    if (s == OK && (rti->pictures || rti->terms != 6))
        s = fail(MERLIN_WRONG_USE, "a .ptm file has polynomials: make it of MERLIN_RTI_PTM or MERLIN_RTI_LRGB");
    if (s == OK) s = make(rti, rti->how.basis == MERLIN_RTI_PTM, &m);
    if (s == OK) s = rti_write_ptm(path, &m.planes);
    made_free(&m);
    return s;
}
