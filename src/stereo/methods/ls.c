/* SPDX-License-Identifier: MIT */
/* Lambertian least squares (R. J. Woodham, Photometric method for determining surface orientation from multiple images,
 * Optical Engineering 19(1), 1980): per pixel the weighted 3×3 normal equations over observations that are neither dark
 * nor saturated, with one right-hand side per colour channel.
 *
 * Pictures are streamed: a block of pixels small enough for the cache is summed over all pictures (ls_sums.h), so that
 * every sample is read from memory once and working memory does not grow with the number of pictures. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "base/parallel.h"
#include "stereo/algebra/matrix3.h"
#include "stereo/methods/ls_lanes.h"
#include "stereo/methods/ls_sums.h"
#include "stereo/methods/solve_parts.h"

/* Number of pixels from which the limit of dark values is derived. */
enum { SAMPLE = 1024 };

typedef struct ls_job {
    const merlin_capture *capture;
    const ls_lights *lights;
    merlin_surface *out;
    float per_unit; /* albedo of 1 in the sums */
} ls_job;

/* Solutions for a block, one component after the other, so that pixels are processed together in vector registers. */
typedef struct solutions {
    float normal[3][LS_BLOCK], albedo[3][LS_BLOCK], residual[LS_BLOCK];
} solutions;

/* Makes a normal of any length unit and facing the camera, without a branch. The least z does not matter within a
 * factor of two, which saves a square root. */
static inline vec3 facing(vec3 n)
{
    return vec3_make(n.x, n.y, max_of(n.z, 1e-3f * (fabsf(n.x) + fabsf(n.y)) + 1e-18f));
}

typedef struct symmetric {
    float xx, xy, xz, yy, yz, zz;
} symmetric;

static inline vec3 times(symmetric m, vec3 v)
{
    return vec3_make(m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
                     m.xz * v.x + m.yz * v.y + m.zz * v.z);
}

static inline vec3 right_side(const ls_sums *s, int channel, int i)
{
    return vec3_make(s->right[channel][0][i], s->right[channel][1][i], s->right[channel][2][i]);
}

/* Solves for LS_LANES pixels. The channels share the normal, not the albedo: each is weighted by its own albedo, which
 * is one step of the power iteration for the best rank-one fit to all channels. Channels that a grey picture lacks are
 * zero and have no effect. */
static void solve_lanes(const ls_sums *restrict s, int count, float per_unit, solutions *restrict out)
{
#pragma omp simd
    for (int i = 0; i < count; i++) {
        symmetric m = {s->matrix[0][i], s->matrix[1][i], s->matrix[2][i],
                       s->matrix[3][i], s->matrix[4][i], s->matrix[5][i]};
        pst_factors factors = pst_factor3(m.xx, m.xy, m.xz, m.yy, m.yz, m.zz);
        vec3 r = right_side(s, 0, i), g = right_side(s, 1, i), b = right_side(s, 2, i);
        vec3 n = facing(pst_solve_factored(factors, vec3_add(vec3_add(r, g), b)));
        vec3 weighted = vec3_scale(r, max_of(vec3_dot(r, n), 0));
        weighted = vec3_fma(weighted, max_of(vec3_dot(g, n), 0), g);
        weighted = vec3_fma(weighted, max_of(vec3_dot(b, n), 0), b);
        n = facing(pst_solve_factored(factors, weighted));
        n = vec3_scale(n, 1 / sqrtf(vec3_dot(n, n)));
        float share = 1 / max_of(vec3_dot(n, times(m, n)), 1e-12f);
        float red = max_of(vec3_dot(r, n), 0), green = max_of(vec3_dot(g, n), 0), blue = max_of(vec3_dot(b, n), 0);
        float explained = share * (red * red + green * green + blue * blue);
        out->normal[0][i] = n.x;
        out->normal[1][i] = n.y;
        out->normal[2][i] = n.z;
        out->albedo[0][i] = red * (share * per_unit);
        out->albedo[1][i] = green * (share * per_unit);
        out->albedo[2][i] = blue * (share * per_unit);
        float fits = explained > 0 ? 1.0f : 0.0f;
        out->residual[i] = fits * sqrtf(max_of(s->square[i] - explained, 0) / max_of(explained, 1e-37f));
    }
}

static inline float inside(float mask, float x)
{
    return mask > 0.5f ? x : 0;
}

/* Loads a component of LS_LANES pixels, zero outside the mask. */
static inline void take(const float *from, const ls_lane_bits *counts, ls_lanes *to)
{
    memcpy(to, from, sizeof *to);
    *to = (ls_lanes)((ls_lane_bits)*to & *counts);
}

static void store_triples(const float from[3][LS_BLOCK], int count, const float *mask, float *to)
{
    int i = 0;
    for (; i + LS_LANES <= count; i += LS_LANES) {
        ls_lanes m, x, y, z;
        memcpy(&m, mask + i, sizeof m);
        ls_lane_bits counts = m > 0.5f;
        take(from[0] + i, &counts, &x);
        take(from[1] + i, &counts, &y);
        take(from[2] + i, &counts, &z);
        ls_lanes_weave(&x, &y, &z, to + (size_t)i * 3);
    }
    for (; i < count; i++)
        for (int c = 0; c < 3; c++)
            to[3 * i + c] = inside(mask[i], from[c][i]);
}

static void store_values(const float *restrict from, int count, const float *restrict mask, float *restrict to)
{
#pragma omp simd
    for (int i = 0; i < count; i++)
        to[i] = inside(mask[i], from[i]);
}

static void store(const solutions *a, int count, const float *mask, const merlin_surface *out, size_t first)
{
    float *albedo = out->albedo.data + (size_t)out->albedo.channels * first;
    store_triples(a->normal, count, mask, out->normal.data + 3 * first);
    if (out->albedo.channels == 3)
        store_triples(a->albedo, count, mask, albedo);
    else
        store_values(a->albedo[0], count, mask, albedo);
    store_values(a->residual, count, mask, out->residual.data + first);
}

static void solve_block(const ls_job *job, size_t first, int count)
{
    const float *mask = job->capture->mask.data + first;
    int any = 0;
#pragma omp simd reduction(| : any)
    for (int i = 0; i < count; i++)
        any |= mask[i] > 0.5f;
    if (!any) return;
    ls_sums sums;
    solutions found;
    ls_sums_add(job->lights, first, count, &sums);
    solve_lanes(&sums, count, job->per_unit, &found);
    store(&found, count, mask, job->out, first);
}

static void solve_blocks(void *context, size_t begin, size_t end)
{
    const ls_job *job = context;
    size_t size = (size_t)job->capture->width * (size_t)job->capture->height;
    for (size_t b = begin; b < end; b++) {
        size_t first = b * LS_BLOCK, left = size - first;
        solve_block(job, first, (int)(left < LS_BLOCK ? left : LS_BLOCK));
    }
}

/* Returns the largest mean over a pixel's channels in any picture, in codes. */
static double brightest(const merlin_capture *c, size_t pixel)
{
    uint32_t top = 0;
    size_t channels = (size_t)c->channels;
    for (int k = 0; k < c->count; k++) {
        uint32_t sum = 0;
        for (size_t ch = 0; ch < channels; ch++)
            sum += pst_code(&c->picture[k], channels * pixel + ch);
        top = sum > top ? sum : top;
    }
    return (double)top / (double)channels;
}

/* Returns a hundredth of the brightest values of the object's pixels, averaged over an evenly spread sample. */
static float chosen_shadow(const merlin_capture *c)
{
    size_t size = (size_t)c->width * (size_t)c->height, step = size / SAMPLE + 1, count = 0;
    double sum = 0;
    for (size_t begin = 0; begin < size; begin += step) {
        size_t end = begin + step < size ? begin + step : size, i = begin;
        while (i < end && !(c->mask.data[i] > 0.5f))
            i++;
        if (i == end) continue;
        sum += brightest(c, i);
        count++;
    }
    return (float)(0.01 * sum / (65535.0 * (double)count));
}

static double mean_intensity(const pst_problem *p)
{
    double sum = 0;
    int count = p->capture->count, channels = p->capture->channels;
    for (int k = 0; k < count; k++)
        for (int ch = 0; ch < channels; ch++)
            sum += (double)p->light[k].intensity[ch];
    return sum / (count * channels);
}

/* Scales the lights to mean intensity 1: a channel's weight is the third power of its sum, which would exceed a float's
 * range under lights of a million. */
static status lights_in_unit(const pst_problem *p, ls_limits limits, double unit, ls_lights **out)
{
    size_t count = (size_t)p->capture->count;
    merlin_light *light = malloc(count * sizeof *light);
    if (!light) return fail(MERLIN_NO_MEMORY, "no memory for %zu lights", count);
    memcpy(light, p->light, count * sizeof *light);
    for (size_t k = 0; k < count; k++)
        for (int ch = 0; ch < 3; ch++)
            light[k].intensity[ch] = (float)((double)light[k].intensity[ch] / unit);
    pst_problem same = *p;
    same.light = light;
    status s = ls_lights_new(&same, limits, out);
    free(light);
    return s;
}

status pst_solve_ls(const pst_problem *p, merlin_surface *out)
{
    const merlin_capture *c = p->capture;
    ls_limits limits = {.low = chosen_shadow(c) * 65535 * (float)c->channels,
                        .high = fminf(ceilf(p->saturation * 65535), 65535)};
    ls_lights *lights;
    double unit = mean_intensity(p);
    status s = lights_in_unit(p, limits, unit, &lights);
    if (s != OK) return s;
    ls_job job = {.capture = c, .lights = lights, .out = out, .per_unit = (float)(1 / unit)};
    size_t size = (size_t)c->width * (size_t)c->height;
    parallel_blocks((size + LS_BLOCK - 1) / LS_BLOCK, solve_blocks, &job);
    ls_lights_free(lights);
    return OK;
}
