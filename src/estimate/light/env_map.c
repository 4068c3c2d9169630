/* SPDX-License-Identifier: MIT */
#include "estimate/light/env_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/color.h"
#include "image/resize.h"
#include "optics/latlong.h"
#include "optics/octahedron.h"
#include "optics/sh.h"

enum { WIDEST_MAP = 2 * ENV_MAP_SIDE };

/* ---- the octahedron -------------------------------------------------------------------------------------------- */

/* Returns a texel. Beyond an edge of the square the octahedron continues at the same edge, mirrored. */
static const float *texel(const img *level, int x, int y)
{
    int n = level->width;
    if (x < 0 || x >= n) {
        x = x < 0 ? -1 - x : 2 * n - 1 - x;
        y = n - 1 - y;
    }
    if (y < 0 || y >= n) {
        y = y < 0 ? -1 - y : 2 * n - 1 - y;
        x = n - 1 - x;
    }
    return img_at(level, x, y);
}

static vec3 interpolate(const img *level, float x, float y)
{
    float at_x = x * (float)level->width - 0.5f, at_y = y * (float)level->width - 0.5f;
    int left = (int)floorf(at_x), top = (int)floorf(at_y);
    float fx = at_x - (float)left, fy = at_y - (float)top, out[3];
    const float *a = texel(level, left, top), *b = texel(level, left + 1, top);
    const float *c = texel(level, left, top + 1), *d = texel(level, left + 1, top + 1);
    for (int i = 0; i < 3; i++)
        out[i] = (1 - fy) * ((1 - fx) * a[i] + fx * b[i]) + fy * ((1 - fx) * c[i] + fx * d[i]);
    return vec3_of(out);
}

/* ---- from latitude and longitude ------------------------------------------------------------------------------- */

typedef struct collection {
    img *sum;      /* radiance times solid angle */
    double *angle; /* solid angle */
} collection;

static void collect(const collection *to, vec3 d, const float *radiance, float angle)
{
    float x, y;
    int side = to->sum->width;
    octahedron_place(d, &x, &y);
    int column = (int)fminf(x * (float)side, (float)side - 1), row = (int)fminf(y * (float)side, (float)side - 1);
    float *cell = img_at(to->sum, column, row);
    for (int c = 0; c < 3; c++)
        cell[c] += radiance[c] * angle;
    to->angle[(size_t)row * (size_t)side + (size_t)column] += (double)angle;
}

/* Adds a row of the map. Each texel is divided into enough pieces that none is larger than a third of a cell. */
static void collect_row(const collection *to, const img *map, int y)
{
    float cell = sqrtf(4 * PI) / (float)to->sum->width;
    int down = (int)ceilf(3 * PI / ((float)map->height * cell));
    for (int i = 0; i < down; i++) {
        float v = ((float)y + ((float)i + 0.5f) / (float)down) / (float)map->height;
        float angle = latlong_solid_angle(y * down + i, map->width, map->height * down);
        int across = (int)ceilf(3 * 2 * PI * sinf(PI * v) / ((float)map->width * cell));
        for (int x = 0; x < map->width; x++)
            for (int k = 0; k < across; k++) {
                float u = ((float)x + ((float)k + 0.5f) / (float)across) / (float)map->width;
                collect(to, latlong_direction(u, v), img_at(map, x, y), angle / (float)across);
            }
    }
}

/* Divides by the solid angle collected, so that a constant sky stays constant. */
static void average(const collection *c)
{
    size_t cells = (size_t)c->sum->width * (size_t)c->sum->width;
    for (size_t i = 0; i < cells; i++)
        for (size_t k = 3 * i; k < 3 * i + 3; k++)
            c->sum->data[k] = c->angle[i] > 0 ? c->sum->data[k] / (float)c->angle[i] : 0;
}

static status resample(const img *map, img *out)
{
    status s = img_new(out, ENV_MAP_SIDE, ENV_MAP_SIDE, 3);
    if (s != OK) return s;
    collection c = {out, calloc((size_t)ENV_MAP_SIDE * ENV_MAP_SIDE, sizeof *c.angle)};
    if (!c.angle) return fail(MERLIN_NO_MEMORY, "no memory for an environment map");
    for (int y = 0; y < map->height; y++)
        collect_row(&c, map, y);
    average(&c);
    free(c.angle);
    return OK;
}

static void halve(const img *from, const img *to)
{
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++)
            for (int c = 0; c < 3; c++) {
                const float *above = img_at(from, 2 * x, 2 * y) + c, *below = img_at(from, 2 * x, 2 * y + 1) + c;
                img_at(to, x, y)[c] = 0.25f * (above[0] + above[3] + below[0] + below[3]);
            }
}

static void project(const img *map, float sh[9][3])
{
    memset(sh, 0, 9 * sizeof *sh);
    for (int y = 0; y < map->height; y++) {
        float angle = latlong_solid_angle(y, map->width, map->height);
        for (int x = 0; x < map->width; x++) {
            const float *c = img_at(map, x, y);
            vec3 d = latlong_direction(((float)x + 0.5f) / (float)map->width, ((float)y + 0.5f) / (float)map->height);
            sh_accumulate(sh, d, vec3_make(c[0] * angle, c[1] * angle, c[2] * angle));
        }
    }
}

status env_map_new(img *latlong, env_map *out)
{
    *out = (env_map){.cosine = 1};
    img map = {0};
    if (latlong->channels != 3) return fail(MERLIN_WRONG_USE, "an environment map needs 3 channels");
    img_zero_invalid(latlong);
    /* at most as wide as the octahedron resolves */
    int width = latlong->width < WIDEST_MAP ? latlong->width : WIDEST_MAP;
    int height = latlong->height < WIDEST_MAP / 2 ? latlong->height : WIDEST_MAP / 2;
    status s = img_resize(latlong, width, height, &map);
    if (s == OK) s = resample(&map, &out->levels[0]);
    for (int i = 1; i < ENV_MAP_LEVELS && s == OK; i++) {
        int side = ENV_MAP_SIDE >> i;
        s = img_new(&out->levels[i], side, side, 3);
        if (s == OK) halve(&out->levels[i - 1], &out->levels[i]);
    }
    if (s == OK) project(&map, out->sh);
    img_free(&map);
    if (s != OK) env_map_free(out);
    return s;
}

void env_map_free(env_map *e)
{
    for (int i = 0; i < ENV_MAP_LEVELS; i++)
        img_free(&e->levels[i]);
    *e = (env_map){0};
}

/* ---- use ------------------------------------------------------------------------------------------------------- */

void env_map_turn(env_map *e, float degrees)
{
    float angle = degrees * PI / 180, c = cosf(angle), s = sinf(angle);
    /* ahead is -z: (0, 0, -1) goes to (1, 0, 0) at 90 degrees */
    const float matrix[3][3] = {{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
    sh_turn(e->sh, matrix);
    float cosine = e->cosine * c - e->sine * s;
    e->sine = e->sine * c + e->cosine * s;
    e->cosine = cosine;
}

void env_map_scale(env_map *e, float factor)
{
    for (int i = 0; i < ENV_MAP_LEVELS; i++) {
        size_t count = 3 * (size_t)e->levels[i].width * (size_t)e->levels[i].height;
        for (size_t k = 0; k < count; k++)
            e->levels[i].data[k] *= factor;
    }
    for (int i = 0; i < 27; i++)
        e->sh[i / 3][i % 3] *= factor;
}

float env_map_mean(const env_map *e)
{
    /* band 0 is the mean times the square root of the sphere's area */
    return color_luminance(e->sh[0]) / sqrtf(4 * PI);
}

vec3 env_map_lookup(const env_map *e, vec3 d, float solid_angle)
{
    const float finest = 4 * PI / ((float)ENV_MAP_SIDE * (float)ENV_MAP_SIDE);
    vec3 unturned = vec3_make(e->cosine * d.x + e->sine * d.z, d.y, e->cosine * d.z - e->sine * d.x);
    float x, y, level = 0.5f * log2f(fmaxf(solid_angle, finest) / finest);
    octahedron_place(unturned, &x, &y);
    level = fminf(level, ENV_MAP_LEVELS - 1);
    int fine = (int)level, coarse = fine + 1 < ENV_MAP_LEVELS ? fine + 1 : fine;
    vec3 a = interpolate(&e->levels[fine], x, y), b = interpolate(&e->levels[coarse], x, y);
    return vec3_lerp(a, b, level - (float)fine);
}
