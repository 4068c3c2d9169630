/* SPDX-License-Identifier: MIT */
#include "estimate/object/object_regions.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { BACKGROUND, OBJECT, SEEN, KEPT, HOLE, OUTSIDE, DIRECTIONS = 24 };
static const float KEPT_SHARE = 0.1f, LEAST_HOLE = 1e-3f;
/* Log odds from which on a hole stays, in hundredths. */
static const double HOLE_TOWARD = -100;

/* A region's sums, and the pixels still to be visited. */
typedef struct region {
    const object_view *view;
    const uint8_t *wanted;
    const int32_t *toward;
    uint8_t *object;
    size_t *stack;
    size_t count, wanted_count;
    double toward_sum;
    float weight; /* weight in pixels; those near the picture's middle count more */
} region;

static void add_pixel(region *r, size_t at)
{
    size_t width = (size_t)r->view->width, height = (size_t)r->view->height;
    size_t row = at / width;
    float u = ((float)(at % width) + 0.5f) / (float)width - 0.5f;
    float v = ((float)row + 0.5f) / (float)height - 0.5f;
    r->weight += expf(-4 * (u * u + v * v));
    r->toward_sum += (double)r->toward[at];
    r->wanted_count += r->wanted && r->wanted[at];
    r->count++;
}

/* Changes the connected pixels of value `from` around start to `to`. */
static void flood(region *r, size_t start, uint8_t from, uint8_t to)
{
    size_t depth = 0;
    r->count = r->wanted_count = 0;
    r->weight = 0;
    r->toward_sum = 0;
    r->object[start] = to;
    r->stack[depth++] = start;
    while (depth) {
        size_t at = r->stack[--depth], next[4];
        add_pixel(r, at);
        int count = img_beside(r->view->width, r->view->height, at, next);
        for (int i = 0; i < count; i++) {
            if (r->object[next[i]] != from) continue;
            r->object[next[i]] = to;
            r->stack[depth++] = next[i];
        }
    }
}

static void keep_regions(region *r)
{
    float heaviest = 0;
    const size_t count = r->view->count;
    for (size_t i = 0; i < count; i++) {
        if (r->object[i] != OBJECT) continue;
        flood(r, i, OBJECT, SEEN);
        heaviest = fmaxf(heaviest, r->weight);
    }
    for (size_t i = 0; i < count; i++) {
        if (r->object[i] != SEEN) continue;
        flood(r, i, SEEN, KEPT);
        bool keep = r->wanted ? r->wanted_count > 0 : r->weight >= KEPT_SHARE * heaviest;
        if (!keep) flood(r, i, KEPT, BACKGROUND);
    }
}

static void fill_holes(region *r)
{
    const size_t width = (size_t)r->view->width, count = r->view->count;
    for (size_t i = 0; i < count; i++) {
        size_t x = i % width;
        bool edge = x == 0 || x + 1 == width || i < width || i + width >= count;
        if (edge && r->object[i] == BACKGROUND) flood(r, i, BACKGROUND, OUTSIDE);
    }
    for (size_t i = 0; i < count; i++) {
        if (r->object[i] != BACKGROUND) continue;
        flood(r, i, BACKGROUND, HOLE);
        bool open = (float)r->count >= LEAST_HOLE * (float)count && r->toward_sum < HOLE_TOWARD * (double)r->count;
        flood(r, i, HOLE, open ? OUTSIDE : KEPT);
    }
}

status object_regions_keep(const object_view *v, const uint8_t *wanted, const int32_t *toward, uint8_t *object)
{
    region r = {.view = v, .wanted = wanted, .toward = toward, .object = object};
    r.stack = malloc(v->count * sizeof *r.stack);
    if (!r.stack) return fail(MERLIN_NO_MEMORY, "no memory to look for the object");
    keep_regions(&r);
    fill_holes(&r);
    for (size_t i = 0; i < v->count; i++)
        object[i] = object[i] == KEPT;
    free(r.stack);
    return OK;
}

void object_regions_hull(const object_view *v, const uint8_t *object, uint8_t *hull)
{
    float farthest[DIRECTIONS], across[DIRECTIONS], down[DIRECTIONS];
    const size_t width = (size_t)v->width;
    for (int k = 0; k < DIRECTIONS; k++) {
        float angle = 6.28318531f * (float)k / DIRECTIONS;
        across[k] = cosf(angle);
        down[k] = sinf(angle);
        farthest[k] = -INFINITY;
    }
    for (size_t i = 0; i < v->count; i++) {
        size_t row = i / width;
        for (int k = 0; object[i] && k < DIRECTIONS; k++)
            farthest[k] = fmaxf(farthest[k], (float)(i % width) * across[k] + (float)row * down[k]);
    }
    memset(hull, 1, v->count);
    for (size_t i = 0; i < v->count; i++) {
        size_t row = i / width;
        for (int k = 0; hull[i] && k < DIRECTIONS; k++)
            if ((float)(i % width) * across[k] + (float)row * down[k] > farthest[k] + 1) hull[i] = 0;
    }
}
