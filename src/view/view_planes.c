/* SPDX-License-Identifier: MIT */
#include "view/view_planes.h"

#include <libdeflate.h>
#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"

/* Constants of the encoding, shared with web/scene.js and web/shaders/surface.glsl. */
static const float MOST = 4095, NORMAL_STEPS = 4096, LEAST_ROUGHNESS = 0.03f, DEPTH_STEPS = 65535, COVER_STEPS = 255;
/* Compression level; beyond it files hardly shrink, and take several times as long. */
enum { LEVEL = 9 };

/* ---- ranges ---- */

static view_range range_of(const img *depth, const img *mask, float least)
{
    view_range r = {INFINITY, -INFINITY};
    for (size_t i = 0; i < img_value_count(depth); i++) {
        if (mask && !(mask->data[i] > 0 && mask->data[i] >= least)) continue;
        r.near = fminf(r.near, depth->data[i]);
        r.far = fmaxf(r.far, depth->data[i]);
    }
    return r.near <= r.far ? r : (view_range){1, 1};
}

view_ranges view_ranges_of(const relighter *s)
{
    return (view_ranges){.covered = range_of(&s->full.depth, &s->full.mask, 0),
                         .object = range_of(&s->full.depth, &s->full.mask, 0.5f),
                         .occluder = range_of(&s->occluder.depth, NULL, 0)};
}

/* ---- codes ---- */

static uint16_t whole(float x, float most)
{
    return (uint16_t)(x > 0 ? fminf(roundf(x), most) : 0);
}

static uint16_t code_albedo(float value, const view_range *r)
{
    (void)r;
    return whole(MOST * sqrtf(fmaxf(value, 0)), MOST);
}

static uint16_t code_normal(float value, const view_range *r)
{
    (void)r;
    return whole(NORMAL_STEPS * (value + 1), 2 * NORMAL_STEPS);
}

static uint16_t code_roughness(float value, const view_range *r)
{
    (void)r;
    return whole(-MOST * logf(fmaxf(value, LEAST_ROUGHNESS) / LEAST_ROUGHNESS) / logf(LEAST_ROUGHNESS), MOST);
}

static uint16_t code_depth(float value, const view_range *r)
{
    return r->far > r->near ? whole(DEPTH_STEPS * (value - r->near) / (r->far - r->near), DEPTH_STEPS) : 0;
}

static uint16_t code_cover(float value, const view_range *r)
{
    (void)r;
    return whole(COVER_STEPS * value, COVER_STEPS);
}

static uint16_t code_surface(float value, const view_range *r)
{
    (void)r;
    return value >= 0.5f;
}

/* One channel of a map, zero outside the mask if there is one. */
typedef struct source {
    const char *name;
    const img *map, *mask;
    int channel;
    uint16_t (*code)(float value, const view_range *range);
    const view_range *range;
} source;

static void encode(const source *from, uint16_t *out)
{
    const size_t channels = (size_t)from->map->channels, count = img_value_count(from->map) / channels;
    for (size_t i = 0; i < count; i++)
        if (!from->mask || from->mask->data[i] > 0)
            out[i] = from->code(from->map->data[channels * i + (size_t)from->channel], from->range);
}

/* ---- packing ---- */

static void take_differences(const uint16_t *values, size_t width, size_t height, uint8_t *bytes)
{
    const size_t count = width * height;
    for (size_t i = 0; i < count; i++) {
        const bool first = i % width == 0, top = i < width;
        const int left = first ? 0 : values[i - 1], above = top ? 0 : values[i - width];
        const int corner = first || top ? 0 : values[i - width - 1];
        const int16_t off = (int16_t)(uint16_t)(values[i] - left - above + corner);
        const uint16_t folded = off < 0 ? (uint16_t)(-2 * off - 1) : (uint16_t)(2 * off);
        bytes[i] = (uint8_t)(folded >> 8);
        bytes[count + i] = (uint8_t)folded;
    }
}

static status compress(const uint8_t *bytes, size_t size, view_plane *out)
{
    struct libdeflate_compressor *packer = libdeflate_alloc_compressor(LEVEL);
    const size_t room = packer ? libdeflate_zlib_compress_bound(packer, size) : 0;
    out->data = room ? malloc(room) : NULL;
    if (out->data) out->size = libdeflate_zlib_compress(packer, bytes, size, out->data, room);
    libdeflate_free_compressor(packer);
    return out->size ? OK : fail(MERLIN_NO_MEMORY, "no memory to pack a map of %zu bytes", size);
}

static status pack(const source *from, view_plane *out)
{
    const size_t width = (size_t)from->map->width, height = (size_t)from->map->height, count = width * height;
    uint16_t *values = calloc(count, sizeof *values);
    uint8_t *bytes = malloc(2 * count);
    out->name = from->name;
    status s = OK;
    if (values && bytes) {
        encode(from, values);
        take_differences(values, width, height, bytes);
        s = compress(bytes, 2 * count, out);
    } else {
        s = fail(MERLIN_NO_MEMORY, "no memory to pack a map of %zu x %zu pixels", width, height);
    }
    free(values);
    free(bytes);
    return s;
}

typedef struct packing {
    source from[VIEW_MOST_PLANES];
    view_planes *to;
} packing;

static status pack_one(void *context, size_t i)
{
    const packing *p = context;
    return pack(&p->from[i], &p->to->at[i]);
}

status view_planes_make(const relighter *s, const view_ranges *ranges, view_planes *out)
{
    const surface *f = &s->full;
    const img *mask = &f->mask, *none = NULL;
    *out = (view_planes){.count = 0};
    packing p = {.from = {{"red", &f->albedo, mask, 0, code_albedo, NULL},
                          {"green", &f->albedo, mask, 1, code_albedo, NULL},
                          {"blue", &f->albedo, mask, 2, code_albedo, NULL},
                          {"normal-x", &f->normal, mask, 0, code_normal, NULL},
                          {"normal-y", &f->normal, mask, 1, code_normal, NULL},
                          {"depth", &f->depth, mask, 0, code_depth, &ranges->covered},
                          {"mask", mask, none, 0, code_cover, NULL},
                          {"caster", &s->occluder.depth, none, 0, code_depth, &ranges->occluder},
                          {"caster-mask", &s->occluder.mask, none, 0, code_surface, NULL},
                          {"roughness", &f->roughness, mask, 0, code_roughness, NULL}},
                 .to = out};
    out->count = f->matte ? VIEW_MOST_PLANES - 1 : VIEW_MOST_PLANES;
    status done = parallel_try(out->count, pack_one, &p);
    if (done != OK) view_planes_free(out);
    return done;
}

void view_planes_free(view_planes *planes)
{
    for (size_t i = 0; i < planes->count; i++)
        free(planes->at[i].data);
    *planes = (view_planes){.count = 0};
}
