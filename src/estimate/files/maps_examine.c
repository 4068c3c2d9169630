/* SPDX-License-Identifier: MIT */
#include "estimate/files/maps_examine.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/vec.h"
#include "estimate/relight/maps_surface.h"

enum { MOST_LAYERS = 16 };
/* Shares of the object's pixels that are out of range: with a tenth the map is something else, with a hundredth there
 * is a warning. */
static const double MUCH = 0.1, WORTH_A_WORD = 0.01;

/* ---- valid ranges ---- */

typedef struct range {
    const char *prefix;    /* prefix of the channels' names */
    float low, high;       /* range outside of which values are clamped later */
    float lowest, highest; /* range outside of which values cannot be of such a map */
    const char *words;
} range;

/* Ranges of an estimate's maps, with room for the rounding of half floats. */
static const range of_estimates[] = {
    {"albedo.", -0.01f, 1.01f, -0.5f, 2, "the linear albedo in [0, 1]"},
    {"roughness.", 0.029f, 1.001f, -0.1f, 1.5f, "the roughness in [0.03, 1]"},
    {"depth.", 0.0499f, 20.1f, 1e-6f, 100,
     "the depth in distances of the object, about 1, positive away from the "
     "camera"},
    {"spread.", -0.1f, 90.1f, -1, 200, "the spread of the normals in degrees"},
    {NULL, 0, 0, 0, 0, NULL},
};
/* Ranges of a capture's maps: albedo and depth are in any unit, and depth from distant lights has any zero. */
static const range of_captures[] = {
    {"albedo.", -FLT_MAX, FLT_MAX, 0, FLT_MAX, "the linear albedo, which is not negative"},
    {"spread.", -0.1f, 90.1f, -1, 200, "the spread of the normals in degrees"},
    {NULL, 0, 0, 0, 0, NULL},
};

static bool starts(const char *name, const char *prefix)
{
    return strncmp(name, prefix, strlen(prefix)) == 0;
}

static const range *range_of(const range *table, const char *name)
{
    while (table->prefix && !starts(name, table->prefix))
        table++;
    return table->prefix ? table : NULL;
}

/* ---- one channel ---- */

/* Counts of one channel's values. */
typedef struct tally {
    size_t infinite, first; /* number of pixels that are not finite, and the first of them */
    size_t off, far;        /* number of the object's pixels out of range, and far out of range */
    float lowest, highest;
} tally;

typedef struct examination {
    const char *path;
    const exr_target *layers;
    size_t count;
    bool captured, mends; /* mends: normals become unit */
    const merlin_maps *maps;
    size_t object; /* number of the object's pixels */
    tally tallies[MOST_LAYERS];
} examination;

static void note_value(float value, const range *r, tally *t)
{
    t->off += value < r->low || value > r->high;
    t->far += value < r->lowest || value > r->highest;
    t->lowest = fminf(t->lowest, value);
    t->highest = fmaxf(t->highest, value);
}

static status examine_layer(void *context, size_t i)
{
    examination *e = context;
    const exr_target *layer = &e->layers[i];
    const range *r = range_of(e->captured ? of_captures : of_estimates, layer->name);
    const img mask = e->maps->mask;
    tally t = {.lowest = FLT_MAX, .highest = -FLT_MAX};
    for (int y = 0; y < mask.height; y++) {
        const img_span span = img_row_span(&mask, y);
        for (int x = span.first; x < span.end; x++) {
            const size_t pixel = (size_t)y * (size_t)mask.width + (size_t)x;
            const float value = layer->data[pixel * (size_t)layer->stride], cover = mask.data[pixel];
            if (!(cover > 0)) continue;
            if (!isfinite(value) && t.infinite++ == 0) t.first = pixel;
            if (r && cover > 0.5f && isfinite(value)) note_value(value, r, &t);
        }
    }
    e->tallies[i] = t;
    return OK;
}

static status refuse_infinite(const examination *e, const char *name, const tally *t)
{
    size_t width = (size_t)e->maps->mask.width;
    return fail(MERLIN_BAD_INPUT,
                "%s: %s is not finite in %zu pixel%s, the first at %zu,%zu (column, row): mend them, or make the maps "
                "again",
                e->path, name, t->infinite, t->infinite == 1 ? "" : "s", t->first % width, t->first / width);
}

static status check_layer(const examination *e, size_t i)
{
    const char *name = e->layers[i].name;
    const tally *t = &e->tallies[i];
    const range *r = range_of(e->captured ? of_captures : of_estimates, name);
    if (t->infinite) return refuse_infinite(e, name, t);
    if (!r || (double)t->far < MUCH * (double)e->object) return OK;
    return fail(MERLIN_BAD_INPUT,
                "%s: %s goes from %g to %g, far out of range in %zu of the object's %zu pixels: it should "
                "be %s",
                e->path, name, (double)t->lowest, (double)t->highest, t->far, e->object, r->words);
}

/* ---- the mask ---- */

static status examine_mask(examination *e)
{
    const float slack = 0.5f; /* room for overshoot of an editor's resizing */
    const img mask = e->maps->mask;
    tally t = {.lowest = FLT_MAX, .highest = -FLT_MAX};
    for (size_t i = 0; i < img_value_count(&mask); i++) {
        const float cover = mask.data[i];
        e->object += cover > 0.5f;
        if (!isfinite(cover) && t.infinite++ == 0) t.first = i;
        t.lowest = fminf(t.lowest, cover);
        t.highest = fmaxf(t.highest, cover);
    }
    if (t.infinite) return refuse_infinite(e, "mask.A", &t);
    if (t.lowest < -slack || t.highest > 1 + slack)
        return fail(MERLIN_BAD_INPUT, "%s: mask.A goes from %g to %g: it should be coverage in [0, 1]", e->path,
                    (double)t.lowest, (double)t.highest);
    if (e->object == 0) return fail(MERLIN_BAD_INPUT, "%s: its mask selects nothing, there is no object", e->path);
    return OK;
}

/* ---- normals ---- */

typedef struct normals {
    size_t none, first, off, coded, away; /* numbers of normals without length, not unit, coded as colours, with z below
                                           * 0, and the first without length */
} normals;

static bool is_nearly_unit(vec3 v)
{
    const float square = vec3_dot(v, v);
    return square > 0.81f && square < 1.21f;
}

static bool is_color(vec3 n)
{
    const vec3 decoded = vec3_sub(vec3_scale(n, 2), vec3_make(1, 1, 1));
    return fminf(fminf(n.x, n.y), n.z) > -0.01f && fmaxf(fmaxf(n.x, n.y), n.z) < 1.01f && is_nearly_unit(decoded);
}

/* Makes a normal unit if it differs by more than the rounding of half floats. */
static void straighten(float *values)
{
    const vec3 n = vec3_of(values);
    const float square = vec3_dot(n, n);
    if (square > 0 && isfinite(square) && fabsf(square - 1) > 0.01f) vec3_put(vec3_normalize(n), values);
}

static normals examine_normals(const examination *e)
{
    const img mask = e->maps->mask, map = e->maps->normal;
    normals found = {0};
    for (int y = 0; y < mask.height; y++) {
        const img_span span = img_row_span(&mask, y);
        for (int x = span.first; x < span.end; x++) {
            float *values = img_at(&map, x, y);
            const vec3 n = vec3_of(values);
            const float cover = *img_at(&mask, x, y);
            if (cover > 0.5f) {
                const bool unit = is_nearly_unit(n), none = vec3_dot(n, n) < 0.01f;
                if (none && found.none++ == 0) found.first = (size_t)y * (size_t)mask.width + (size_t)x;
                found.off += !unit;
                found.coded += !unit && is_color(n);
                found.away += n.z < -0.05f;
            }
            if (e->mends && cover > 0) straighten(values);
        }
    }
    return found;
}

static status check_normals(const examination *e, const normals *n)
{
    const double object = (double)e->object;
    const size_t width = (size_t)e->maps->mask.width;
    if ((double)n->coded > 0.5 * object)
        return fail(MERLIN_BAD_INPUT, "%s: its normals seem to be stored as colours, (n + 1)/2: store n itself",
                    e->path);
    /* a solver may leave pixels without a normal */
    if ((double)n->none > (e->captured ? WORTH_A_WORD * object : 0))
        return fail(MERLIN_BAD_INPUT,
                    "%s: the normal has no length in %zu of the object's %zu pixels, the first at %zu,%zu (column, "
                    "row): take them out of mask.A, or make the maps again",
                    e->path, n->none, e->object, n->first % width, n->first / width);
    if ((double)n->away > MUCH * object)
        return fail(MERLIN_BAD_INPUT,
                    "%s: in %zu of the object's %zu pixels the normal points away from the camera: normal.Z should be "
                    "positive toward it",
                    e->path, n->away, e->object);
    return OK;
}

/* ---- the whole ---- */

static float share_off(const examination *e, const char *prefix)
{
    size_t most = 0;
    for (size_t i = 0; i < e->count; i++)
        if (starts(e->layers[i].name, prefix) && e->tallies[i].off > most) most = e->tallies[i].off;
    return (float)((double)most / (double)e->object);
}

static void record_doubts(const examination *e, const normals *n, merlin_maps *maps)
{
    maps->mended.albedo = share_off(e, "albedo.");
    maps->mended.roughness = share_off(e, "roughness.");
    maps->mended.depth = share_off(e, "depth.");
    maps->mended.normal = (float)((double)n->off / (double)e->object);
    if (maps->mended.albedo > 0) maps->doubts |= MERLIN_DOUBT_ALBEDO_CLAMPED;
    if (maps->mended.roughness > 0) maps->doubts |= MERLIN_DOUBT_ROUGHNESS_CLAMPED;
    if (maps->mended.depth > 0) maps->doubts |= MERLIN_DOUBT_DEPTH_CLAMPED;
    if ((double)maps->mended.normal > WORTH_A_WORD) maps->doubts |= MERLIN_DOUBT_NORMALS_NOT_UNIT;
}

static bool has_photo(const exr_target *layers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (starts(layers[i].name, "photo.")) return true;
    return false;
}

static status examine(examination *e, normals *n)
{
    e->captured = !has_photo(e->layers, e->count);
    status s = examine_mask(e);
    if (s == OK) s = parallel_try(e->count, examine_layer, e);
    for (size_t i = 0; i < e->count && s == OK; i++)
        s = check_layer(e, i);
    if (s != OK) return s;
    *n = examine_normals(e);
    return check_normals(e, n);
}

status maps_examine(const char *path, const exr_target *layers, size_t count, merlin_maps *maps)
{
    examination e = {.path = path, .layers = layers, .count = count, .maps = maps, .mends = true};
    normals n;
    status s = examine(&e, &n);
    if (s == OK) record_doubts(&e, &n, maps);
    return s;
}

status maps_look_through(const char *where, const exr_target *layers, size_t count, const merlin_maps *maps)
{
    examination e = {.path = where, .layers = layers, .count = count, .maps = maps};
    normals n;
    return examine(&e, &n);
}

/* ---- the crop ---- */

status maps_check_crop(const char *path, bool sized, const merlin_maps *maps)
{
    const float least_share = 0.55f; /* share of the crop's side; crop_around makes it 0.6 or more */
    const img mask = maps->mask;
    const crop_square c = crop_of(maps);
    const int slack = 2 + c.side / 50; /* in pixels, as the mask was rounded in the meantime */
    if (crop_holds(&mask, c, slack, sized ? 0 : least_share)) return OK;
    return fail(MERLIN_BAD_INPUT,
                "%s: the object is not where its merlinCrop (%d, %d and a side of %d) has it: resize, crop or turn the "
                "photograph, and estimate the maps of it",
                path, c.x, c.y, c.side);
}
