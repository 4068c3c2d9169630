/* SPDX-License-Identifier: MIT */
#include "estimate/object/border_distance.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/parallel.h"

enum { SIDES = 4, SCANS = 6 };
static const float LIKE_COLOR = 0.06f;

static status no_memory(void)
{
    return fail(MERLIN_NO_MEMORY, "no memory to look for the object");
}

/* ---- the background's part of the border ---- */

/* Pixels of the ring, side after side, with the colours of neighbours next to one another. */
typedef struct border {
    size_t first[SIDES + 1];
    size_t *pixel;
    float *r, *g, *b;
    uint8_t *seed; /* seeds, a value for every pixel of the picture; borrowed */
} border;

static status border_new(size_t ring, border *out)
{
    float *colors = malloc(3 * ring * sizeof *colors);
    *out = (border){.pixel = malloc(ring * sizeof *out->pixel), .r = colors};
    if (!colors || !out->pixel) return no_memory();
    out->g = colors + ring;
    out->b = colors + 2 * ring;
    return OK;
}

static void border_free(border *b)
{
    free(b->r);
    free(b->pixel);
}

/* Returns the nearest of the picture's four sides. */
static int side_of(const img *color, size_t i)
{
    int x = (int)(i % (size_t)color->width), y = (int)(i / (size_t)color->width);
    const int away[SIDES] = {x, color->width - 1 - x, y, color->height - 1 - y};
    int best = 0;
    for (int k = 1; k < SIDES; k++)
        if (away[k] < away[best]) best = k;
    return best;
}

static void list_border(const img *color, const uint8_t *ring, border *out)
{
    size_t n = 0, count = (size_t)color->width * (size_t)color->height;
    for (int side = 0; side < SIDES; side++) {
        for (size_t i = 0; i < count; i++) {
            if (!ring[i] || side_of(color, i) != side) continue;
            out->pixel[n] = i;
            out->r[n] = color->data[3 * i];
            out->g[n] = color->data[3 * i + 1];
            out->b[n++] = color->data[3 * i + 2];
        }
        out->first[side + 1] = n;
    }
}

/* Returns the least squared distance of entry i's colour to one of begin .. end - 1. */
static float nearest_color(const border *b, size_t i, size_t begin, size_t end)
{
    const float *red = b->r, *green = b->g, *blue = b->b;
    float nearest = FLT_MAX, r = red[i], g = green[i], c = blue[i];
#pragma omp simd reduction(min : nearest)
    for (size_t j = begin; j < end; j++) {
        float dr = red[j] - r, dg = green[j] - g, db = blue[j] - c;
        float distance = dr * dr + dg * dg + db * db;
        nearest = distance < nearest ? distance : nearest;
    }
    return nearest;
}

/* Finds out which border pixels have a similar colour on another side. */
static void find_likes(void *context, size_t begin, size_t end)
{
    const border *b = context;
    int side = 0;
    for (size_t i = begin; i < end; i++) {
        while (i >= b->first[side + 1])
            side++;
        float before = nearest_color(b, i, 0, b->first[side]);
        float behind = nearest_color(b, i, b->first[side + 1], b->first[SIDES]);
        b->seed[b->pixel[i]] = (before < behind ? before : behind) < LIKE_COLOR * LIKE_COLOR;
    }
}

/* Chooses the background's part of the border; if hardly any of it resembles another side, all of it. */
static status choose_seeds(const img *color, const uint8_t *ring, uint8_t *seed)
{
    border b;
    size_t length = 0, seeds = 0;
    for (size_t i = 0, count = (size_t)color->width * (size_t)color->height; i < count; i++)
        length += ring[i];
    status s = border_new(length, &b);
    b.seed = seed;
    if (s == OK) {
        list_border(color, ring, &b);
        parallel_blocks(length, find_likes, &b);
        for (size_t i = 0; i < length; i++)
            seeds += seed[b.pixel[i]];
        for (size_t i = 0; i < length && 3 * seeds < length; i++)
            seed[b.pixel[i]] = 1;
    }
    border_free(&b);
    return s;
}

/* ---- the way there ---- */

/* State of one channel's barrier distance, found by a few raster scans (Zhang et al. 2015). */
typedef struct barrier {
    const float *value; /* channel values, three floats apart */
    float *cost, *high, *low;
    int width, height;
} barrier;

static void barrier_visit(barrier *b, size_t at, size_t from)
{
    float x = b->value[3 * at], high = fmaxf(b->high[from], x), low = fminf(b->low[from], x);
    if (high - low >= b->cost[at]) return;
    b->cost[at] = high - low;
    b->high[at] = high;
    b->low[at] = low;
}

static void barrier_scan(barrier *b, bool backward)
{
    size_t width = (size_t)b->width, height = (size_t)b->height, count = width * height;
    for (size_t k = 0; k < count; k++) {
        size_t i = backward ? count - 1 - k : k, x = i % width, y = i / width;
        if (!backward && x > 0) barrier_visit(b, i, i - 1);
        if (!backward && y > 0) barrier_visit(b, i, i - width);
        if (backward && x + 1 < width) barrier_visit(b, i, i + 1);
        if (backward && y + 1 < height) barrier_visit(b, i, i + width);
    }
}

static status add_barriers(const img *color, const uint8_t *seed, img *out)
{
    size_t count = (size_t)color->width * (size_t)color->height;
    float *memory = calloc(count, 3 * sizeof *memory);
    if (!memory) return no_memory();
    for (int c = 0; c < 3; c++) {
        barrier b = {color->data + c, memory, memory + count, memory + 2 * count, color->width, color->height};
        for (size_t i = 0; i < count; i++) {
            b.cost[i] = seed[i] ? 0 : FLT_MAX;
            b.high[i] = b.low[i] = b.value[3 * i];
        }
        for (int scan = 0; scan < SCANS; scan++)
            barrier_scan(&b, scan & 1);
        for (size_t i = 0; i < count; i++)
            out->data[i] += fminf(b.cost[i], 1);
    }
    free(memory);
    return OK;
}

status barrier_distance(const img *color, const uint8_t *seed, img *out)
{
    status s = img_new(out, color->width, color->height, 1);
    if (s == OK) s = add_barriers(color, seed, out);
    if (s != OK) img_free(out);
    return s;
}

status border_distance(const img *color, const uint8_t *ring, img *out)
{
    uint8_t *seed = calloc((size_t)color->width * (size_t)color->height, 1);
    *out = (img){0};
    status s = seed ? choose_seeds(color, ring, seed) : no_memory();
    if (s == OK) s = barrier_distance(color, seed, out);
    free(seed);
    return s;
}
