/* SPDX-License-Identifier: MIT */
#include "estimate/light/reflections.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/parallel.h"
#include "estimate/light/lobe_sampler.h"
#include "optics/brdf.h"
#include "optics/camera.h"

/* Sizes in pixels: side of a block that is processed at once, of its largest and smallest squares, and the spacing of
 * stored points, which include the smallest squares' centres. */
enum { BLOCK = 32, LARGEST = 16, SMALLEST = 4, SPACING = SMALLEST / 2, POINTS = BLOCK / SPACING + 1 };
/* Number of roughnesses that are evaluated, a constant factor of 1.08 apart. */
enum { KNOTS = 48 };
/* Largest side of a square in steps between the points at which the horizon is known. */
enum { HORIZONS = 4 };
/* Limits for interpolation: the distance between the corners' mirror directions and that of a pixel's normal from the
 * interpolated one, in widths of the lobe; and the error in the middle, relative to the value there and to the mean
 * reflection. They were found by trial (docs/notes/environments.md). */
static const float SPREAD = 0.25f, RELIEF = 0.03f, ERROR = 0.02f, DARKEST = 0.1f;

typedef struct job {
    const surface *s;
    camera eye;
    lobe_sampler lobe;
    int largest;   /* largest side of a square that may be interpolated */
    float darkest; /* radiance below which errors are not relative to it */
    img *image;
} job;

typedef struct block {
    const job *j;
    int x, y;
    uint64_t known[POINTS * POINTS]; /* one bit per knot */
    vec3 radiance[POINTS * POINTS][KNOTS];
} block;

/* A square of a block. */
typedef struct tile {
    int x, y, side;
} tile;

static vec3 at3(const img *image, int x, int y)
{
    return vec3_of(img_at(image, x, y));
}

static vec3 between(const vec3 at[4], float u, float v)
{
    return vec3_lerp(vec3_lerp(at[0], at[1], u), vec3_lerp(at[2], at[3], u), v);
}

static vec3 view_at(const job *j, int x, int y)
{
    return vec3_scale(camera_ray(&j->eye, (float)x + 0.5f, (float)y + 0.5f), -1);
}

static vec3 reflection_at(const job *j, int x, int y, float roughness)
{
    float across = ((float)x + 0.5f) / (float)j->eye.width, down = ((float)y + 0.5f) / (float)j->eye.height;
    return lobe_reflection(&j->lobe,
                           &(lobe_point){at3(&j->s->normal, x, y), view_at(j, x, y), roughness, across, down});
}

static void add_pixel(const job *j, int x, int y, vec3 radiance)
{
    float *out = img_at(j->image, x, y);
    vec3_put(vec3_fma(vec3_of(out), *img_at(&j->s->mask, x, y), radiance), out);
}

static void add_pixels(const block *b, const tile *t)
{
    const job *j = b->j;
    for (int y = t->y; y < t->y + t->side && y < j->eye.height; y++)
        for (int x = t->x; x < t->x + t->side && x < j->eye.width; x++)
            if (*img_at(&j->s->mask, x, y) > 0)
                add_pixel(j, x, y, reflection_at(j, x, y, *img_at(&j->s->roughness, x, y)));
}

/* ---- knots ---- */

static float knot_of(float roughness)
{
    return log2f(fmaxf(roughness / BRDF_MIN_ROUGHNESS, 1)) * (KNOTS - 1) / -log2f(BRDF_MIN_ROUGHNESS);
}

static vec3 radiance_at(block *b, int x, int y, int knot)
{
    int at = (y - b->y) / SPACING * POINTS + (x - b->x) / SPACING;
    uint64_t bit = (uint64_t)1 << knot;
    if (!(b->known[at] & bit)) {
        float roughness = powf(BRDF_MIN_ROUGHNESS, 1 - (float)knot / (KNOTS - 1));
        b->radiance[at][knot] = reflection_at(b->j, x, y, roughness);
        b->known[at] |= bit;
    }
    return b->radiance[at][knot];
}

static void corners_at(block *b, const tile *t, int knot, vec3 out[4])
{
    for (int k = 0; k < 4; k++)
        out[k] = radiance_at(b, t->x + k % 2 * t->side, t->y + k / 2 * t->side, knot);
}

/* ---- smoothness ---- */

/* Returns the angular width of mirror directions in radians: that of the lobe and of the map's resolution. */
static float width_of_lobe(float roughness)
{
    const float texel2 = 4 * PI / (ENV_MAP_SIDE * ENV_MAP_SIDE);
    return sqrtf(4 * brdf_alpha2(roughness) + texel2);
}

/* Gets the corners' normals; returns false if a corner lies outside the surface. */
static bool corner_normals(const job *j, const tile *t, vec3 out[4])
{
    if (t->x + t->side >= j->eye.width || t->y + t->side >= j->eye.height) return false;
    for (int k = 0; k < 4; k++) {
        int x = t->x + k % 2 * t->side, y = t->y + k / 2 * t->side;
        if (!(*img_at(&j->s->mask, x, y) > 0)) return false;
        out[k] = at3(&j->s->normal, x, y);
    }
    return *img_at(&j->s->mask, t->x + t->side / 2, t->y + t->side / 2) > 0;
}

/* Returns the largest distance of the corners' mirror directions from their mean. */
static float spread_of(const job *j, const tile *t, const vec3 normals[4])
{
    vec3 mirrored[4], mean = {0, 0, 0};
    float most = 0;
    for (int k = 0; k < 4; k++) {
        vec3 view = view_at(j, t->x + k % 2 * t->side, t->y + k / 2 * t->side);
        mirrored[k] = vec3_fma(vec3_scale(view, -1), 2 * vec3_dot(view, normals[k]), normals[k]);
        mean = vec3_fma(mean, 0.25f, mirrored[k]);
    }
    for (int k = 0; k < 4; k++)
        most = fmaxf(most, vec3_length(vec3_sub(mirrored[k], mean)));
    return most;
}

/* Statistics of the pixels of a tile. */
typedef struct survey {
    float relief2;     /* largest squared distance of a normal from the interpolated one */
    float least, most; /* range of roughness */
} survey;

static survey survey_of(const job *j, const tile *t, const vec3 normals[4])
{
    survey out = {0, 1, 0};
    for (int y = 0; y < t->side; y++)
        for (int x = 0; x < t->side; x++) {
            if (!(*img_at(&j->s->mask, t->x + x, t->y + y) > 0)) continue;
            vec3 expected = between(normals, (float)x / (float)t->side, (float)y / (float)t->side);
            vec3 off = vec3_sub(at3(&j->s->normal, t->x + x, t->y + y), expected);
            float roughness = *img_at(&j->s->roughness, t->x + x, t->y + y), relief2 = vec3_dot(off, off);
            out.relief2 = relief2 > out.relief2 ? relief2 : out.relief2;
            out.least = roughness < out.least ? roughness : out.least;
            out.most = roughness > out.most ? roughness : out.most;
        }
    return out;
}

static bool middle_is_between(block *b, const tile *t, int knot)
{
    vec3 at[4], middle = radiance_at(b, t->x + t->side / 2, t->y + t->side / 2, knot);
    corners_at(b, t, knot, at);
    vec3 off = vec3_sub(between(at, 0.5f, 0.5f), middle);
    float error = fmaxf(fabsf(off.x), fmaxf(fabsf(off.y), fabsf(off.z)));
    return error <= ERROR * fmaxf(b->j->darkest, fmaxf(middle.x, fmaxf(middle.y, middle.z)));
}

static bool is_smooth(block *b, const tile *t)
{
    vec3 normals[4];
    if (!corner_normals(b->j, t, normals)) return false;
    float spread = spread_of(b->j, t, normals);
    if (spread > SPREAD * width_of_lobe(*img_at(&b->j->s->roughness, t->x, t->y))) return false;
    survey seen = survey_of(b->j, t, normals);
    float width = width_of_lobe(seen.least);
    /* a mirror direction turns twice as far as the normal */
    if (spread > SPREAD * width || 4 * seen.relief2 > RELIEF * RELIEF * width * width) return false;
    float least = knot_of(seen.least);
    return knot_of(seen.most) - least < (float)t->side && middle_is_between(b, t, (int)least);
}

/* ---- assembly ---- */

static void add_between(block *b, const tile *t)
{
    const surface *s = b->j->s;
    for (int y = 0; y < t->side; y++)
        for (int x = 0; x < t->side; x++) {
            if (!(*img_at(&s->mask, t->x + x, t->y + y) > 0)) continue;
            float knot = knot_of(*img_at(&s->roughness, t->x + x, t->y + y));
            int below = (int)fminf(knot, KNOTS - 2);
            float u = (float)x / (float)t->side, v = (float)y / (float)t->side;
            vec3 sharp[4], blunt[4];
            corners_at(b, t, below, sharp);
            corners_at(b, t, below + 1, blunt);
            add_pixel(b->j, t->x + x, t->y + y,
                      vec3_lerp(between(sharp, u, v), between(blunt, u, v), knot - (float)below));
        }
}

static bool is_empty(const job *j, const tile *t)
{
    for (int y = t->y; y < t->y + t->side && y < j->eye.height; y++)
        for (int x = t->x; x < t->x + t->side && x < j->eye.width; x++)
            if (*img_at(&j->s->mask, x, y) > 0) return false;
    return true;
}

static void add_tile(block *b, tile t)
{
    if (t.side <= b->j->largest && is_smooth(b, &t)) {
        add_between(b, &t);
    } else if (t.side == SMALLEST) {
        add_pixels(b, &t);
    } else {
        for (int k = 0, half = t.side / 2; k < 4; k++)
            add_tile(b, (tile){t.x + k % 2 * half, t.y + k / 2 * half, half});
    }
}

static int blocks_across(const job *j)
{
    return (j->eye.width + BLOCK - 1) / BLOCK;
}

static void add_block(void *context, size_t i)
{
    const job *j = context;
    int at = (int)i, across = blocks_across(j);
    tile whole = {at % across * BLOCK, at / across * BLOCK, BLOCK};
    if (is_empty(j, &whole)) return;
    block b;
    b.j = j;
    b.x = whole.x;
    b.y = whole.y;
    memset(b.known, 0, sizeof b.known);
    add_tile(&b, whole);
}

void surface_add_reflections(const surface *s, const env_map *env, const horizon *h, img *image)
{
    job j = {.s = s, .eye = surface_camera(s), .image = image};
    lobe_over(env, h, &j.lobe);
    j.largest = h ? HORIZONS * j.eye.width / h->cosine.width : LARGEST;
    if (j.largest > LARGEST) j.largest = LARGEST;
    j.darkest = DARKEST * BRDF_F0 * env_map_mean(env);
    size_t down = (size_t)((j.eye.height + BLOCK - 1) / BLOCK);
    parallel_for((size_t)blocks_across(&j) * down, add_block, &j);
}
