/* SPDX-License-Identifier: MIT */
#include "lab/eval/metrics/composite.h"

#include <math.h>
#include <stdbool.h>

#include "base/rng.h"
#include "image/color.h"
#include "image/resize.h"
#include "lab/scene/shape/noise.h"
#include "optics/light.h"

enum { STREAM = 0x3a5c, MOST_THINGS = 9, TABLE_BITS = 8 };

/* A rectangle of one colour at the picture's border; lengths in parts of the picture's side. */
typedef struct thing {
    float x, y, half_width, half_height, cosine, sine;
    vec3 color;
} thing;

/* Everything that is drawn at random before a pixel is made. */
typedef struct stage_set {
    composite_kind kind;
    uint32_t seed;
    float scale, left, top;    /* of the sample's frame within the picture, whose side is 1 */
    vec3 wall, floor, ambient; /* albedo, albedo, radiance of white */
    float wall_distance, floor_height, horizon;
    bool has_floor;
    float tilt_x, tilt_y; /* increase of the wall's brightness to the right and downwards */
    float grain, grain_stretch, grain_depth;
    float shadow_x, shadow_y, shadow_depth;
    float white, noise;
    int defocus;
    thing things[MOST_THINGS];
    int thing_count;
} stage_set;

const char *composite_name(composite_kind kind)
{
    static const char *const names[COMPOSITE_KINDS] = {"dark", "wall", "floor", "desk", "room"};
    return names[kind];
}

void composite_free(composite *c)
{
    img_free(&c->photo);
    img_free(&c->mask);
}

/* ---- random choices ---- */

static vec3 draw_color(rng *r, float least, float most)
{
    float value = rng_range(r, least, most), saturation = rng_uniform(r) * rng_uniform(r);
    vec3 tint = vec3_make(rng_uniform(r), rng_uniform(r), rng_uniform(r));
    vec3 span = vec3_make(1 + saturation * (2 * tint.x - 1), 1 + saturation * (2 * tint.y - 1),
                          1 + saturation * (2 * tint.z - 1));
    return vec3_scale(span, value);
}

static vec3 mean_albedo(const sample *s)
{
    vec3 sum = {0, 0, 0};
    float count = 0;
    for (size_t i = 0; i < img_value_count(&s->mask); i++) {
        if (s->mask.data[i] < 1) continue;
        sum = vec3_add(sum, vec3_of(s->albedo.data + 3 * i));
        count++;
    }
    return vec3_scale(sum, 1 / fmaxf(count, 1));
}

static void draw_things(rng *r, stage_set *set)
{
    set->thing_count = 3 + rng_below(r, MOST_THINGS - 3);
    for (int i = 0; i < MOST_THINGS; i++) {
        thing *t = &set->things[i];
        float along = rng_uniform(r), in = rng_range(r, -0.05f, 0.12f), angle = rng_range(r, -0.4f, 0.4f);
        int side = rng_below(r, 4);
        t->x = side == 0 ? in : side == 1 ? 1 - in : along;
        t->y = side == 2 ? in : side == 3 ? 1 - in : along;
        t->half_width = rng_range(r, 0.03f, 0.22f);
        t->half_height = rng_range(r, 0.03f, 0.22f);
        t->cosine = cosf(angle);
        t->sine = sinf(angle);
        t->color = draw_color(r, 0.02f, 0.7f);
    }
}

/* Returns the lowest row of the object as a share of the frame's side. */
static float base_of(const sample *s)
{
    for (int y = s->mask.height - 1; y >= 0; y--)
        for (int x = 0; x < s->mask.width; x++)
            if (*img_at(&s->mask, x, y) >= 0.5f) return (float)(y + 1) / (float)s->mask.height;
    return 1;
}

/* Tells whether the frame cuts the object off, which then cannot be shown smaller. */
static bool is_cut(const img *mask)
{
    int last = mask->width - 1;
    for (int i = 0; i <= last; i++)
        if (*img_at(mask, i, 0) > 0 || *img_at(mask, i, last) > 0 || *img_at(mask, 0, i) > 0 ||
            *img_at(mask, last, i) > 0)
            return true;
    return false;
}

static void draw_place(rng *r, const sample *s, stage_set *set)
{
    float base = base_of(s), cut = rng_uniform(r);
    set->scale = rng_range(r, 0.62f, 1.05f);
    if (is_cut(&s->mask)) set->scale = 1;
    float room = 1 - set->scale;
    set->left = room * rng_range(r, 0.2f, 0.8f);
    set->top = room * rng_range(r, 0.2f, 0.8f);
    if (cut < 0.15f && set->scale != 1) set->top = 1 + 0.06f - set->scale * base; /* the picture ends within it */
    base = set->top + set->scale * base;
    set->horizon = base - rng_range(r, 0.12f, 0.6f);
    set->floor_height = fmaxf(base - set->horizon, 0.1f) * 2 * tanf(PI / 6); /* at the object's depth of 1 */
}

static void draw_light(rng *r, const sample *s, stage_set *set)
{
    bool lit = rng_uniform(r) < 0.4f;
    set->ambient = lit ? vec3_scale(draw_color(r, 0.4f, 1.2f), rng_uniform(r)) : vec3_make(0, 0, 0);
    set->wall = draw_color(r, 0.05f, 0.8f);
    set->floor = draw_color(r, 0.03f, 0.7f);
    vec3 like = vec3_scale(mean_albedo(s), rng_range(r, 0.7f, 1.3f));
    float alike = rng_uniform(r);
    if (alike < 0.1f) set->wall = like;
    if (alike > 0.9f) set->floor = like;
    set->wall_distance = rng_range(r, 1.25f, 3.5f);
    set->tilt_x = rng_range(r, -0.5f, 0.5f);
    set->tilt_y = rng_range(r, -0.5f, 0.5f);
    set->shadow_x = rng_range(r, -0.05f, 0.05f);
    set->shadow_y = rng_range(r, 0, 0.04f);
    set->shadow_depth = rng_range(r, 0.3f, 0.95f);
    set->white = rng_range(r, 1, 2.5f);
    set->noise = rng_range(r, 0.002f, 0.012f);
}

static stage_set draw_set(const sample *s, uint64_t seed, composite_kind kind)
{
    stage_set set = {.kind = kind};
    rng r = rng_at(seed, s->index, STREAM + (uint64_t)kind);
    set.seed = rng_u32(&r);
    draw_place(&r, s, &set);
    draw_light(&r, s, &set);
    float floor = rng_uniform(&r);
    set.has_floor = kind == COMPOSITE_FLOOR || kind == COMPOSITE_DESK || (kind == COMPOSITE_ROOM && floor < 0.6f);
    set.grain = expf(rng_range(&r, logf(6), logf(60)));
    set.grain_stretch = rng_range(&r, 1, 8);
    set.grain_depth = rng_range(&r, 0.2f, 0.9f);
    set.defocus = rng_below(&r, 6);
    draw_things(&r, &set);
    if (kind != COMPOSITE_ROOM) set.thing_count = 0;
    if (kind == COMPOSITE_DARK) set.wall_distance = rng_range(&r, 5, 12);
    if (kind == COMPOSITE_DARK) set.ambient = vec3_make(0, 0, 0);
    if (kind == COMPOSITE_DARK || kind == COMPOSITE_WALL || kind == COMPOSITE_FLOOR) set.defocus = 0;
    return set;
}

/* ---- the background ---- */

/* Returns the radiance of a matte surface at p under flash and room. */
static vec3 lit(const stage_set *set, vec3 albedo, vec3 p, vec3 normal)
{
    float square = vec3_dot(p, p), distance = sqrtf(square);
    float flash = LIGHT_POWER / PI * fmaxf(-vec3_dot(p, normal), 0) / (distance * square);
    return vec3_mul(albedo, vec3_add(set->ambient, vec3_make(flash, flash, flash)));
}

static vec3 textured(const stage_set *set, vec3 p)
{
    if (set->kind != COMPOSITE_DESK) return set->floor;
    vec3 at = vec3_make(set->grain * p.x, 0, set->grain * p.z / set->grain_stretch);
    float height = noise_fbm(at, 4, set->seed);
    return vec3_scale(set->floor, fmaxf(1 + 2 * set->grain_depth * height, 0.05f));
}

static const thing *thing_at(const stage_set *set, float x, float y)
{
    for (int i = 0; i < set->thing_count; i++) {
        const thing *t = &set->things[i];
        float u = x - t->x, v = y - t->y;
        if (fabsf(u * t->cosine + v * t->sine) < t->half_width && fabsf(v * t->cosine - u * t->sine) < t->half_height)
            return t;
    }
    return NULL;
}

/* Returns the radiance behind the object at a place of the picture, whose side is 1. */
static vec3 background_at(const stage_set *set, float x, float y)
{
    const float half = tanf(PI / 6);
    vec3 ray = vec3_make((2 * x - 1) * half, 2 * (set->horizon - y) * half, -1);
    float slope = 1 + set->tilt_x * (x - 0.5f) + set->tilt_y * (y - 0.5f);
    const thing *t = thing_at(set, x, y);
    float depth = set->has_floor && ray.y < 0 ? set->floor_height / -ray.y : set->wall_distance;
    bool floor = depth < set->wall_distance;
    vec3 flat = vec3_make(ray.x, (1 - 2 * y) * half, -1);
    if (t) return lit(set, t->color, vec3_scale(flat, 0.8f * fminf(depth, set->wall_distance)), vec3_make(0, 0, 1));
    if (!floor) return vec3_scale(lit(set, set->wall, vec3_scale(flat, depth), vec3_make(0, 0, 1)), slope);
    vec3 p = vec3_scale(ray, depth);
    return lit(set, textured(set, p), p, vec3_make(0, 1, 0));
}

static status make_background(const stage_set *set, int side, img *out)
{
    status s = img_new(out, side, side, 3);
    for (int y = 0; s == OK && y < side; y++)
        for (int x = 0; x < side; x++) {
            float u = ((float)x + 0.5f) / (float)side, v = ((float)y + 0.5f) / (float)side;
            vec3_put(background_at(set, u, v), img_at(out, x, y));
        }
    return s;
}

static status blur(img *image, int radius)
{
    if (radius == 0) return OK;
    img weight = {0};
    status s = img_new(&weight, image->width, image->height, 1);
    for (size_t i = 0; s == OK && i < img_value_count(&weight); i++)
        weight.data[i] = 1;
    if (s == OK) s = img_box_sums(&weight, radius);
    if (s == OK) s = img_box_sums(image, radius);
    for (size_t i = 0; s == OK && i < img_value_count(image); i++)
        image->data[i] /= weight.data[i / (size_t)image->channels];
    img_free(&weight);
    return s;
}

/* ---- the object ---- */

/* Resamples from the sample's frame to the picture's. */
static status place(const img *from, const stage_set *set, img *out)
{
    float side = (float)from->width;
    int scaled = (int)fmaxf(roundf(set->scale * side), 8);
    img small = {0};
    status s = img_resize(from, scaled, scaled, &small);
    if (s == OK)
        s = img_crop(&small, -(int)roundf(set->left * side), -(int)roundf(set->top * side), from->width, from->height,
                     out);
    img_free(&small);
    for (size_t i = 0; s == OK && i < img_value_count(out); i++)
        out->data[i] = fmaxf(out->data[i], 0); /* enlarging causes ringing */
    return s;
}

/* Renders flash and room light on the object, times coverage. */
static status light_object(const sample *s, const stage_set *set, img *out)
{
    status st = img_copy(out, &s->direct);
    if (st != OK) return st;
    const float ambient[3] = {set->ambient.x, set->ambient.y, set->ambient.z};
    for (size_t i = 0; i < img_value_count(out); i++) {
        float up = 0.65f + 0.35f * s->normal.data[i / 3 * 3 + 1];
        out->data[i] += s->indirect.data[i] + s->mask.data[i / 3] * s->albedo.data[i] * ambient[i % 3] * up;
    }
    return OK;
}

/* Darkens the background by the object's shadow and, if it stands on something, below it. */
static status cast_shadow(const img *mask, const stage_set *set, img *background)
{
    img soft = {0};
    int side = mask->width, dx = (int)roundf(set->shadow_x * (float)side),
        dy = (int)roundf(set->shadow_y * (float)side);
    if (set->kind == COMPOSITE_DARK) return OK;
    status s = img_crop(mask, -dx, -dy, side, side, &soft);
    if (s == OK) s = blur(&soft, set->has_floor ? side / 64 + 1 : side / 128);
    for (size_t i = 0; s == OK && i < img_value_count(background); i++)
        background->data[i] *= 1 - set->shadow_depth * fminf(soft.data[i / 3], 1);
    img_free(&soft);
    return s;
}

/* Converts to a camera's values: white, noise, 8 bits. */
static void expose(const stage_set *set, uint64_t seed, img *photo)
{
    const float *values = srgb_decode_table8();
    rng r = rng_at(seed, set->seed, STREAM);
    for (size_t i = 0; i < img_value_count(photo); i++) {
        float value = fmaxf(photo->data[i] / set->white, 0);
        value += set->noise * (0.15f + sqrtf(fminf(value, 1))) * rng_normal(&r);
        photo->data[i] = values[srgb_code8(value)];
    }
}

static status compose(const sample *s, const stage_set *set, img *photo, img *mask)
{
    img object = {0}, placed = {0};
    status st = make_background(set, s->mask.width, photo);
    if (st == OK) st = blur(photo, set->defocus * s->mask.width / 256);
    if (st == OK) st = place(&s->mask, set, mask);
    if (st == OK) st = light_object(s, set, &object);
    if (st == OK) st = place(&object, set, &placed);
    if (st == OK) st = cast_shadow(mask, set, photo);
    for (size_t i = 0; st == OK && i < img_value_count(photo); i++) {
        mask->data[i / 3] = fminf(mask->data[i / 3], 1);
        photo->data[i] = placed.data[i] + (1 - mask->data[i / 3]) * photo->data[i];
    }
    img_free(&object);
    img_free(&placed);
    return st;
}

status composite_make(const sample *s, uint64_t seed, composite_kind kind, composite *out)
{
    *out = (composite){0};
    stage_set set = draw_set(s, seed, kind);
    status st = compose(s, &set, &out->photo, &out->mask);
    if (st == OK) expose(&set, seed, &out->photo);
    if (st != OK) composite_free(out);
    return st;
}
