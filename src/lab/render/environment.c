/* SPDX-License-Identifier: MIT */
#include "lab/render/environment.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "image/color.h"
#include "lab/render/sky.h"
#include "optics/brdf.h"
#include "optics/latlong.h"
#include "optics/sh.h"

/* Converts a unit direction to map coordinates in texels. */
static void place_of(const environment *env, vec3 d, float *x, float *y)
{
    float u, v;
    latlong_place(d, &u, &v);
    *x = u * (float)env->map.width;
    *y = v * (float)env->map.height;
}

/* Returns the solid angle of a texel of row y, as latlong_solid_angle does, from the stored cosines. */
static float texel_solid_angle(const environment *env, int y)
{
    return (env->cosines[y] - env->cosines[y + 1]) * 2 * PI / (float)env->map.width;
}

static float mean_luminance(const environment *env)
{
    const img *map = &env->map;
    double sum = 0;
    for (int y = 0; y < map->height; y++) {
        double row = 0;
        for (int x = 0; x < map->width; x++)
            row += color_luminance(img_at(map, x, y));
        sum += row * texel_solid_angle(env, y);
    }
    return (float)(sum / (4 * M_PI));
}

/* Divides a cumulative sum by its last value; the last entry becomes exactly 1. */
static void normalize_cumulative(float *c, int count)
{
    float total = c[count];
    for (int i = 0; i <= count; i++)
        c[i] = total > 0 ? c[i] / total : (float)i / (float)count;
    c[count] = 1;
}

/* Computes the sampling distribution: a texel's light, plus a little so that light interpolated into dark texels is
 * sampled, too. */
static void fill_distribution(environment *env, float floor_luminance)
{
    int w = env->map.width, h = env->map.height;
    env->rows[0] = 0;
    for (int y = 0; y < h; y++) {
        float *row = env->columns + (size_t)y * (size_t)(w + 1);
        row[0] = 0;
        for (int x = 0; x < w; x++)
            row[x + 1] = row[x] + color_luminance(img_at(&env->map, x, y)) + floor_luminance;
        env->rows[y + 1] = env->rows[y] + row[w] * texel_solid_angle(env, y);
        normalize_cumulative(row, w);
    }
    normalize_cumulative(env->rows, h);
}

static void project_sh(environment *env)
{
    memset(env->sh, 0, sizeof env->sh);
    for (int y = 0; y < env->map.height; y++) {
        float angle = texel_solid_angle(env, y);
        for (int x = 0; x < env->map.width; x++) {
            const float *c = img_at(&env->map, x, y);
            vec3 d = latlong_direction(((float)x + 0.5f) / (float)env->map.width,
                                       ((float)y + 0.5f) / (float)env->map.height);
            sh_accumulate(env->sh, d, vec3_make(c[0] * angle, c[1] * angle, c[2] * angle));
        }
    }
}

/* Scales the map so that its mean luminance is `exposure`, then derives everything else from it. */
static status finish(environment *env, float exposure)
{
    size_t w = (size_t)env->map.width, h = (size_t)env->map.height;
    env->rows = malloc((h + 1) * sizeof *env->rows);
    env->cosines = malloc((h + 1) * sizeof *env->cosines);
    env->columns = malloc(h * (w + 1) * sizeof *env->columns);
    if (!env->rows || !env->cosines || !env->columns) {
        environment_free(env);
        return fail(MERLIN_NO_MEMORY, "out of memory for an environment map");
    }
    for (size_t y = 0; y <= h; y++)
        env->cosines[y] = cosf(PI * (float)y / (float)h);
    float mean = mean_luminance(env), scale = mean > 0 ? exposure / mean : 0;
    for (size_t i = 0; i < 3 * w * h; i++)
        env->map.data[i] *= scale;
    fill_distribution(env, 0.05f * exposure);
    project_sh(env);
    return OK;
}

/* Returns a random mean radiance, with which a grey object looks between dim and well lit. */
static float random_exposure(rng *r)
{
    return 0.35f * powf(3.2f, rng_uniform(r));
}

status environment_procedural(rng *r, environment *out)
{
    *out = (environment){0};
    status s = img_new(&out->map, ENVIRONMENT_WIDTH, ENVIRONMENT_HEIGHT, 3);
    if (s != OK) return s;
    sky_fill(&out->map, r);
    return finish(out, random_exposure(r));
}

status environment_from_map(const img *map, rng *r, environment *out)
{
    *out = (environment){0};
    status s = img_new(&out->map, map->width, map->height, 3);
    if (s != OK) return s;
    int turn = rng_below(r, map->width);
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++)
            memcpy(img_at(&out->map, (x + turn) % map->width, y), img_at(map, x, y), 3 * sizeof(float));
    out->tents = true; /* a photographed sun is one texel, most of whose light interpolation puts into its neighbours */
    return finish(out, random_exposure(r));
}

void environment_free(environment *env)
{
    img_free(&env->map);
    free(env->rows);
    free(env->cosines);
    free(env->columns);
    *env = (environment){0};
}

/* The four texels around a position, and their weights. */
typedef struct neighbours {
    int x[2], y[2];
    float share[2][2]; /* weights of rows and columns */
} neighbours;

static neighbours around(const environment *env, float x, float y)
{
    int w = env->map.width, h = env->map.height;
    x -= 0.5f;
    y = clamp(y - 0.5f, 0, (float)h - 1);
    int x0 = (int)floorf(x), y0 = (int)y;
    float fx = x - (float)x0, fy = y - (float)y0;
    int left = x0 < 0 ? x0 + w : x0 < w ? x0 : x0 - w;
    return (neighbours){.x = {left, left + 1 < w ? left + 1 : 0},
                        .y = {y0, y0 + 1 < h ? y0 + 1 : y0},
                        .share = {{(1 - fy) * (1 - fx), (1 - fy) * fx}, {fy * (1 - fx), fy * fx}}};
}

static vec3 radiance_of(const environment *env, const neighbours *n)
{
    float out[3] = {0};
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++)
            for (int c = 0; c < 3; c++)
                out[c] += n->share[j][i] * img_at(&env->map, n->x[i], n->y[j])[c];
    return vec3_of(out);
}

static vec3 radiance_at(const environment *env, float x, float y)
{
    neighbours n = around(env, x, y);
    return radiance_of(env, &n);
}

static float texel_probability(const environment *env, int x, int y)
{
    const float *row = env->columns + (size_t)y * (size_t)(env->map.width + 1);
    return (env->rows[y + 1] - env->rows[y]) * (row[x + 1] - row[x]);
}

/* Returns the density per solid angle; directions within a texel are uniform in u and cosθ. */
static float texel_pdf(const environment *env, int x, int y)
{
    return texel_probability(env, x, y) / texel_solid_angle(env, y);
}

/* Returns the density per solid angle at height y of sampling with tents: interpolated as radiance is. */
static float tents_pdf(const environment *env, const neighbours *n, float y)
{
    float w = (float)env->map.width, h = (float)env->map.height, probability = 0;
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++)
            probability += n->share[j][i] * texel_probability(env, n->x[i], n->y[j]);
    return probability * w * h / (2 * PI * PI * fmaxf(1e-6f, sinf(PI * y / h)));
}

/* Returns the density where directions are sampled uniformly inside texels. */
static float even_pdf(const environment *env, float x, float y)
{
    int i = (int)x, j = (int)y;
    if (i >= env->map.width) i = env->map.width - 1;
    if (j >= env->map.height) j = env->map.height - 1;
    return texel_pdf(env, i, j);
}

vec3 environment_look(const environment *env, vec3 d, real *pdf)
{
    float x, y;
    place_of(env, d, &x, &y);
    neighbours n = around(env, x, y);
    *pdf = env->tents ? tents_pdf(env, &n, y) : even_pdf(env, x, y);
    return radiance_of(env, &n);
}

/* Positions of numbers in cumulative sums: the interval, and the offset within it. */
typedef struct falls {
    int interval[LANES];
    float within[LANES];
} falls;

/* Finds the intervals; lane i's sum of `count` intervals begins at cumulative[first[i]]. Bisection without branches, as
 * they would be unpredictable. */
static void find_intervals(const float *cumulative, const int first[LANES], int count, const float u[LANES], falls *out)
{
    int low[LANES];
    for (int i = 0; i < LANES; i++)
        low[i] = first[i];
    for (int left = count; left > 1;) {
        int half = left / 2;
#pragma omp simd
        for (int i = 0; i < LANES; i++)
            low[i] += cumulative[low[i] + half] <= u[i] ? half : 0;
        left -= half;
    }
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        float start = cumulative[low[i]], width = cumulative[low[i] + 1] - start;
        float share = (u[i] - start) / width;
        out->within[i] = width > 0 ? (share < 0.9999f ? share : 0.9999f) : 0.5f;
        out->interval[i] = low[i] - first[i];
    }
}

/* Maps [0, 1) to (-1, 1) with a triangular density. */
static float tent(float u)
{
    return u < 0.5f ? sqrtf(2 * u) - 1 : 1 - sqrtf(2 - 2 * u);
}

/* Places directions in and around the chosen texels. A tent that extends beyond a pole is folded back. */
static void place_in_tents(const environment *env, const falls *across, const falls *down, int count,
                           environment_rays *out)
{
    float w = (float)env->map.width, h = (float)env->map.height;
    for (int i = 0; i < count; i++) {
        float x = (float)across->interval[i] + 0.5f + tent(across->within[i]);
        float y = fabsf((float)down->interval[i] + 0.5f + tent(down->within[i]));
        x = x < 0 ? x + w : x < w ? x : x - w;
        y = y < h ? y : 2 * h - y;
        lanes_put(&out->direction, i, latlong_direction(x / w, y / h));
        neighbours n = around(env, x, y);
        lanes_put(&out->radiance, i, radiance_of(env, &n));
        out->pdf[i] = tents_pdf(env, &n, y);
    }
}

void environment_sample(const environment *env, const float u1[LANES], const float u2[LANES], int count,
                        environment_rays *out)
{
    int w = env->map.width, h = env->map.height, row[LANES] = {0};
    float x[LANES], y[LANES];
    falls down, across;
    find_intervals(env->rows, row, h, u1, &down);
    for (int i = 0; i < LANES; i++)
        row[i] = down.interval[i] * (w + 1);
    find_intervals(env->columns, row, w, u2, &across);
    if (env->tents) {
        place_in_tents(env, &across, &down, count, out);
        return;
    }
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        float top = env->cosines[down.interval[i]], bottom = env->cosines[down.interval[i] + 1], c, s;
        float cosine = top + down.within[i] * (bottom - top), rest = 1 - cosine * cosine;
        float sine = sqrtf(rest > 0 ? rest : 0);
        x[i] = (float)across.interval[i] + across.within[i];
        y[i] = cosine;
        brdf_turn(x[i] / (float)w, &c, &s);
        lanes_put(&out->direction, i, vec3_make(-sine * s, cosine, sine * c));
    }
    for (int i = 0; i < count; i++) {
        out->pdf[i] = texel_pdf(env, across.interval[i], down.interval[i]);
        lanes_put(&out->radiance, i, radiance_at(env, x[i], acosf(y[i]) / PI * (float)h));
    }
}
