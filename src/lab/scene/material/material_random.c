/* SPDX-License-Identifier: MIT */
/* Random materials: plain, painted, of natural patterns or weathered, in frequencies as of real objects. */
#include <stdlib.h>

#include "base/number.h"
#include "lab/scene/material/material.h"
#include "lab/scene/material/palette.h"

static const uint32_t ALL_PARTS = 0xffffffffu;

/* State shared by the steps of making one material. */
typedef struct maker {
    rng *r;
    scene_material *out;
    const triangle_mesh *mesh;
    bool mirrored;
    int parts;
    vec3 palette[PALETTE];
    float gloss; /* typical roughness of the object */
} maker;

static bool chance(maker *m, float p)
{
    return rng_uniform(m->r) < p;
}

/* Returns a log-uniform number. */
static float scale_between(maker *m, float low, float high)
{
    return low * powf(high / low, rng_uniform(m->r));
}

static float any_gloss(maker *m)
{
    float kind = rng_uniform(m->r);
    if (kind < 0.38f) return rng_range(m->r, 0.1f, 0.35f);
    if (kind < 0.68f) return rng_range(m->r, 0.3f, 0.6f);
    return rng_range(m->r, 0.6f, 1);
}

static float paint_gloss(maker *m)
{
    return chance(m, 0.65f) ? m->gloss + 0.06f * rng_normal(m->r) : any_gloss(m);
}

static vec3 any_colour(maker *m)
{
    return m->palette[rng_below(m->r, PALETTE)];
}

static vec3 shade_of(maker *m, vec3 colour, float strength)
{
    float light = expf(strength * rng_normal(m->r)), tint = 0.25f * strength;
    real *channel[] = {&colour.x, &colour.y, &colour.z};
    for (int k = 0; k < 3; k++)
        *channel[k] = clamp(*channel[k] * light * (1 + tint * rng_normal(m->r)), 0.008f, 0.95f);
    return colour;
}

static pattern pattern_between(maker *m, pattern_kind kind, float low, float high)
{
    return pattern_random(m->r, kind, scale_between(m, low, high), m->mesh, m->mirrored);
}

static material_paint plain_paint(maker *m, vec3 colour)
{
    return (material_paint){.colours = 1, .colour = {colour}, .roughness = paint_gloss(m)};
}

/* Returns an almost plain paint: shades of one colour, as on hand-painted or worn surfaces. */
static material_paint shaded_paint(maker *m, vec3 colour)
{
    material_paint p = plain_paint(m, colour);
    p.colours = 2;
    p.colour[1] = shade_of(m, colour, rng_range(m->r, 0.1f, 0.6f));
    p.mix = pattern_between(m, chance(m, 0.75f) ? PATTERN_FBM : PATTERN_TURBULENCE, 1, 12);
    if (chance(m, 0.4f)) p.spread = rng_range(m->r, -0.3f, 0.3f);
    return p;
}

/* Returns wood, marble, granite or scales: two or three colours through one strong pattern. */
static material_paint patterned_paint(maker *m)
{
    static const pattern_kind KINDS[] = {PATTERN_FBM,     PATTERN_FBM,   PATTERN_TURBULENCE,  PATTERN_CELLS,
                                         PATTERN_STRIPES, PATTERN_RINGS, PATTERN_MARBLE,      PATTERN_CELL_EDGES,
                                         PATTERN_MARBLE,  PATTERN_BANDS, PATTERN_CELL_VALUES, PATTERN_GRADIENT};
    material_paint p = {.colours = 2 + rng_below(m->r, 2), .roughness = paint_gloss(m)};
    vec3 first = any_colour(m);
    bool kin = chance(m, 0.55f); /* shades of one colour rather than several */
    for (int i = 0; i < 3; i++)
        p.colour[i] = i == 0 ? first : kin ? shade_of(m, first, 0.7f) : any_colour(m);
    pattern_kind kind = KINDS[rng_below(m->r, (int)(sizeof KINDS / sizeof *KINDS))];
    bool gradient = kind == PATTERN_GRADIENT;
    p.mix = pattern_between(m, kind, gradient ? 0.6f : 1.2f, gradient ? 1.5f : 10);
    if (!gradient && chance(m, 0.6f)) p.mix.warp = rng_range(m->r, 0.1f, 0.9f);
    if (chance(m, 0.4f)) {
        float width = scale_between(m, 0.06f, 0.8f);
        pattern_threshold(&p.mix, rng_uniform(m->r), width);
    }
    if (chance(m, 0.6f)) p.spread = rng_range(m->r, -0.5f, 0.5f);
    return p;
}

static material_paint any_paint(maker *m)
{
    float kind = rng_uniform(m->r);
    if (kind < 0.55f) return plain_paint(m, any_colour(m));
    if (kind < 0.85f) return shaded_paint(m, any_colour(m));
    return patterned_paint(m);
}

static void add_layer(maker *m, uint32_t parts, const pattern *mask, float opacity, material_paint p)
{
    scene_material *out = m->out;
    if (out->layers == LAYERS) return;
    p.roughness = clamp(p.roughness, 0.1f, 1);
    material_layer *l = &out->layer[out->layers++];
    *l = (material_layer){.parts = parts, .everywhere = mask == NULL, .opacity = opacity, .paint = p};
    if (mask) l->mask = *mask;
}

/* Returns a region with a border, mostly sharp, as of paint. */
static pattern any_region(maker *m)
{
    static const pattern_kind KINDS[] = {PATTERN_FBM,     PATTERN_FBM,         PATTERN_FBM,        PATTERN_PATCHES,
                                         PATTERN_PATCHES, PATTERN_PATCHES,     PATTERN_CELL_EDGES, PATTERN_STRIPES,
                                         PATTERN_RINGS,   PATTERN_MARBLE,      PATTERN_SPOTS,      PATTERN_SPOTS,
                                         PATTERN_CHECKS,  PATTERN_LETTERS,     PATTERN_LETTERS,    PATTERN_BANDS,
                                         PATTERN_BANDS,   PATTERN_CELL_VALUES, PATTERN_GRADIENT,   PATTERN_GRADIENT};
    pattern_kind kind = KINDS[rng_below(m->r, (int)(sizeof KINDS / sizeof *KINDS))];
    float low = 1, high = 6;
    if (kind == PATTERN_SPOTS || kind == PATTERN_CHECKS || kind == PATTERN_LETTERS) low = 2.5f, high = 9;
    if (kind == PATTERN_PATCHES) low = 1.5f;
    if (kind == PATTERN_GRADIENT) low = 0.7f, high = 1.5f;
    pattern p = pattern_between(m, kind, low, high);
    float width = chance(m, 0.75f) ? rng_range(m->r, 0.02f, 0.07f) : scale_between(m, 0.1f, 0.6f);
    pattern_threshold(&p, rng_uniform(m->r), width);
    return p;
}

/* Adds a base for each part (often one for all), the same on paired parts. */
static void add_bases(maker *m, bool patterned)
{
    add_layer(m, ALL_PARTS, NULL, 1, patterned ? patterned_paint(m) : any_paint(m));
    if (m->parts == 1 || chance(m, 0.3f)) return;
    int more = 1 + rng_below(m->r, 4);
    for (int i = 0; i < more; i++) {
        uint32_t parts = m->parts == 2 ? 2u : rng_u32(m->r) & (i ? rng_u32(m->r) : ALL_PARTS);
        add_layer(m, parts, NULL, 1, chance(m, patterned ? 0.5f : 0.1f) ? patterned_paint(m) : any_paint(m));
    }
}

/* Adds concentric rings of colour around the same centres: eyes, targets, petals. */
static void add_rings(maker *m)
{
    pattern p = pattern_between(m, PATTERN_PATCHES, 1.5f, 4);
    float at = rng_range(m->r, 0.55f, 0.75f);
    for (int i = 0; i < 2 + rng_below(m->r, 2); i++) {
        p.low = at;
        p.high = at + 0.02f;
        add_layer(m, ALL_PARTS, &p, 1, plain_paint(m, any_colour(m)));
        at += rng_range(m->r, 0.06f, 0.16f);
    }
}

static void add_painting(maker *m)
{
    int count = 1 + rng_below(m->r, 4);
    for (int i = 0; i < count; i++) {
        pattern region = any_region(m);
        uint32_t parts = m->parts > 1 && chance(m, 0.4f) ? rng_u32(m->r) : ALL_PARTS;
        add_layer(m, parts, &region, 1, any_paint(m));
    }
    if (chance(m, 0.25f)) add_rings(m);
}

/* Adds dirt, dust and wear: soft, rough, half transparent; or shiny scratches. */
static void add_wear(maker *m)
{
    bool scratched = chance(m, 0.3f);
    pattern where = scratched ? pattern_between(m, PATTERN_SCRATCHES, 2, 6) : pattern_between(m, PATTERN_FBM, 1, 6);
    float share = rng_range(m->r, 0.2f, 0.6f), width = rng_range(m->r, 0.2f, 0.6f);
    pattern_threshold(&where, share, scratched ? 0.2f : width);
    float hue = rng_range(m->r, 0.05f, 0.12f), saturation = rng_range(m->r, 0.1f, 0.5f);
    vec3 colour = chance(m, 0.5f) ? colour_hsv(hue, saturation, 0.35f) : any_colour(m);
    material_paint p = plain_paint(m, colour);
    p.roughness = scratched ? any_gloss(m) : rng_range(m->r, 0.6f, 1);
    add_layer(m, ALL_PARTS, &where, rng_range(m->r, 0.2f, 0.7f), p);
}

static void add_bump(maker *m, const pattern *p, float frequency, float slope, uint32_t parts)
{
    scene_material *out = m->out;
    if (out->bumps == BUMPS) return;
    out->bump[out->bumps++] = (material_bump){
        .parts = parts, .pattern = *p, .height = slope / frequency, .step = min_of(0.01f, 0.08f / frequency)};
}

/* Adds grain, dents, scales, hammer marks or cloth, with slopes from faint to strong. */
static void add_grain(maker *m)
{
    static const pattern_kind KINDS[] = {PATTERN_FBM,        PATTERN_FBM,       PATTERN_FBM,
                                         PATTERN_TURBULENCE, PATTERN_CELLS,     PATTERN_CELL_EDGES,
                                         PATTERN_STRIPES,    PATTERN_SCRATCHES, PATTERN_SPOTS};
    pattern_kind kind = KINDS[rng_below(m->r, (int)(sizeof KINDS / sizeof *KINDS))];
    float frequency = scale_between(m, 2, kind == PATTERN_FBM ? 24 : 14);
    pattern p = pattern_random(m->r, kind, frequency, m->mesh, m->mirrored);
    if (frequency > 10) p.octaves = 1 + rng_below(m->r, 2);
    float u = rng_uniform(m->r), slope = 0.04f + 0.55f * u * u;
    if (kind == PATTERN_SCRATCHES) slope *= 0.25f; /* its lines are much steeper than its features are wide */
    uint32_t parts = m->parts > 1 && chance(m, 0.3f) ? rng_u32(m->r) : ALL_PARTS;
    add_bump(m, &p, frequency, chance(m, 0.5f) ? -slope : slope, parts);
}

/* Carves or raises the border of a painted region. */
static void emboss_top_layer(maker *m)
{
    scene_material *out = m->out;
    const material_layer *l = &out->layer[out->layers - 1];
    if (l->everywhere) return;
    pattern p = l->mask;
    float frequency = vec3_length(p.frame.row[0]), middle = 0.5f * (p.low + p.high);
    p.low = middle - 0.12f; /* a slope wide enough to be shaded */
    p.high = middle + 0.12f;
    float side = chance(m, 0.5f) ? -1.0f : 1.0f;
    add_bump(m, &p, frequency, side * rng_range(m->r, 0.04f, 0.15f), l->parts);
}

static void make_material(maker *m)
{
    float style = rng_uniform(m->r);
    if (style < 0.27f) {
        add_layer(m, ALL_PARTS, NULL, 1,
                  chance(m, 0.6f) ? plain_paint(m, any_colour(m)) : shaded_paint(m, any_colour(m)));
    } else if (style < 0.64f) {
        add_bases(m, false);
        add_painting(m);
    } else if (style < 0.86f) {
        add_bases(m, true);
    } else {
        add_bases(m, true);
        add_painting(m);
    }
    if (chance(m, 0.15f)) add_wear(m);
    if (chance(m, 0.2f)) emboss_top_layer(m);
    if (chance(m, 0.36f)) add_grain(m);
    if (chance(m, 0.12f)) add_grain(m);
    if (chance(m, 0.25f)) {
        m->out->smudged = true;
        m->out->smudge = pattern_between(m, PATTERN_FBM, 1, 10);
        m->out->smudge_amount = rng_range(m->r, 0.1f, 0.6f);
    }
}

scene_material *material_random(rng *r, const triangle_mesh *mesh, const shape_traits *traits)
{
    maker m = {.r = r, .out = calloc(1, sizeof *m.out), .mesh = mesh, .parts = traits->parts};
    if (!m.out) return NULL;
    m.mirrored = traits->mirrored && rng_uniform(r) < 0.75f;
    palette_random(r, m.palette);
    m.gloss = any_gloss(&m);
    make_material(&m);
    return m.out;
}

void material_apply_textures(scene_material *material, const scene_textures *textures, rng *r)
{
    bool worn = rng_uniform(r) < 0.75f; /* the others stay procedural */
    for (int i = 0; worn && i < material->layers; i++) {
        material_layer *l = &material->layer[i];
        if (!l->everywhere || (i > 0 && rng_uniform(r) < 0.3f)) continue;
        bool turned = rng_uniform(r) < 0.5f;
        l->paint.photographed =
            (texture_place){.texture = &textures->texture[rng_below(r, (int)textures->count)],
                            .turn = turned ? random_rotation(r) : (mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                            .scale = 0.4f * powf(5, rng_uniform(r)),
                            .offset = random_between(r, 0, 1)};
        if (l->paint.photographed.texture->slope.data) material->embossed = true;
    }
}
