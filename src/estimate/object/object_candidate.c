/* SPDX-License-Identifier: MIT */
#include "estimate/object/object_candidate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "estimate/object/object_holes.h"
#include "estimate/object/object_regions.h"

enum { ROUNDS = 3 };
/* Log odds in integers, for the cut. */
static const float UNIT = OBJECT_UNIT;
/* Largest log odds by a pixel's colour, and by its place. */
static const float MOST_BY_COLOR = 5, MOST_BY_PLACE = 2;
/* Cost of classifying a pixel as background in shadow. */
static const float SHADOW = 3;
/* Least share of the picture from which the background's colours are learned. */
static const float LEAST_OUTSIDE = 0.03f;

void object_candidate_free(object_candidate *c)
{
    free(c->object);
    *c = (object_candidate){0};
}

float object_overlap(const uint8_t *one, const uint8_t *other, size_t count)
{
    size_t both = 0, either = 0;
    for (size_t i = 0; i < count; i++) {
        both += one[i] && other[i];
        either += one[i] || other[i];
    }
    return either ? (float)both / (float)either : 1;
}

void object_toward(const object_candidate *c, const mixture_pixels *pixels, float *cost, int32_t *toward)
{
    const float clip = MOST_BY_COLOR;
    mixture_costs(&c->outside, pixels, SHADOW, cost);
    mixture_costs(&c->inside, pixels, INFINITY, cost + pixels->count);
    for (size_t i = 0; i < pixels->count; i++) {
        float more = cost[i] - cost[pixels->count + i];
        more = more > clip ? clip : more;
        toward[i] = (int32_t)(UNIT * (more < -clip ? -clip : more));
    }
}

/* ---- growth ---- */

/* Memory of the growth of a candidate. */
typedef struct growth {
    object_ground *ground;
    object_candidate *out;
    bool outside_hull;
    uint8_t *hull;
    uint8_t *hole, *new_hole; /* pixels that the object surrounds but that have the background's colours */
    uint8_t *before;          /* object before the last round */
    float *cost;
    int32_t *toward;
} growth;

/* Learns both sides' colours; the background's from outside the object's hull if there is enough of it, so that a part
 * missing from the object does not become background by its own colours. */
static void learn(growth *g)
{
    const object_view *v = g->ground->view;
    object_candidate *c = g->out;
    size_t outside = 0;
    object_regions_hull(v, c->object, g->hull);
    for (size_t i = 0; i < v->count; i++) {
        if (g->hole[i]) g->hull[i] = 0;
        outside += !g->hull[i];
    }
    if ((float)outside < LEAST_OUTSIDE * (float)v->count || !g->outside_hull) memcpy(g->hull, c->object, v->count);
    mixture_learn(&c->inside, &v->pixels, c->object, 1);
    mixture_learn(&c->outside, &v->pixels, g->hull, 0);
}

static status open_holes(growth *g)
{
    bool any;
    status s = object_holes_find(g->ground->view, g->out->object, g->new_hole, &any);
    for (size_t i = 0; s == OK && any && i < g->ground->view->count; i++) {
        g->hole[i] |= g->new_hole[i];
        if (g->hole[i]) g->out->object[i] = 0;
    }
    return s;
}

/* Returns the cost difference by a pixel's place, as an integer for the cut. */
static int32_t by_place(const growth *g, size_t i)
{
    float odds = g->hole[i] ? -MOST_BY_PLACE : g->ground->prior[i];
    return (int32_t)(UNIT * clamp(odds, -MOST_BY_PLACE, MOST_BY_PLACE));
}

static status cut(growth *g)
{
    object_ground *ground = g->ground;
    const object_view *v = ground->view;
    status s = open_holes(g);
    if (s != OK) return s;
    learn(g);
    object_toward(g->out, &v->pixels, g->cost, g->toward);
    for (size_t i = 0; i < v->count; i++) {
        ground->cut.toward[i] = g->toward[i] + by_place(g, i);
        ground->cut.free[i] = !ground->fixed[i];
        if (ground->fixed[i]) g->out->object[i] = ground->fixed[i] - 1;
    }
    s = grid_cut_solve(&ground->cut, g->out->object);
    return s == OK ? object_regions_keep(v, ground->wanted, ground->cut.toward, g->out->object) : s;
}

/* ---- cues ---- */

static void add_outline(const growth *g, object_cues *cues)
{
    const object_view *v = g->ground->view;
    const uint8_t *object = g->out->object;
    const grid_cut *cut = &g->ground->cut;
    double length = 0, weak = 0, change = 0, area = 0;
    for (size_t i = 0; i < v->count; i++) {
        area += object[i];
        for (int d = 0; d < GRID_DOWN_RIGHT; d += 2) {
            size_t j = grid_beside(v->width, v->height, i, d);
            if (j == SIZE_MAX || object[i] == object[j]) continue;
            double tie = (double)cut->tie[d][i] / (double)g->ground->tie;
            length++;
            change += 1 - tie;
            weak += tie > 0.6;
        }
    }
    cues->edge = (float)(change / fmax(length, 1));
    cues->weak = (float)(weak / fmax(length, 1));
    /* a disc's outline in steps is 4/π times its length */
    length *= 3.14159265 / 4;
    cues->compact = (float)(4 * 3.14159265 * area / fmax(length * length, 1));
}

static void add_place(const growth *g, object_cues *cues)
{
    const object_view *v = g->ground->view;
    const uint8_t *object = g->out->object;
    double area = 0, hull = 0, x = 0, y = 0, top = 0, sides = 0, bottom = 0;
    const size_t width = (size_t)v->width, height = (size_t)v->height;
    object_regions_hull(v, object, g->hull);
    for (size_t i = 0; i < v->count; i++) {
        hull += g->hull[i];
        if (!object[i]) continue;
        area++;
        x += (double)(i % width) + 0.5;
        size_t row = i / width;
        y += (double)row + 0.5;
        top += i < width;
        bottom += i + width >= v->count;
        sides += i % width == 0 || i % width + 1 == width;
    }
    area = fmax(area, 1);
    cues->area = (float)(area / (double)v->count);
    cues->solid = (float)(area / fmax(hull, 1));
    cues->top = (float)(top / (double)width);
    cues->bottom = (float)(bottom / (double)width);
    cues->sides = (float)(sides / (double)(2 * height));
    cues->centre = (float)(hypot(2 * x / area / (double)width - 1, 2 * y / area / (double)height - 1) / sqrt(2));
}

static void add_colors(const growth *g, object_cues *cues)
{
    const object_view *v = g->ground->view;
    double sum[2] = {0, 0}, light[2] = {0, 0}, count[2] = {0, 0}, apart = 0, unsure = 0, plain = 0;
    for (size_t i = 0; i < v->count; i++) {
        int side = g->out->object[i];
        double toward = (side ? 1 : -1) * (double)(g->toward[i] / UNIT);
        const float *color = v->color.data + 3 * i;
        count[side]++;
        sum[side] += (double)fminf(g->ground->away[i], 1);
        light[side] += (double)(color[0] + color[1] + color[2]) / 3;
        apart += 1 / (1 + exp(-toward));
        unsure += toward < 0.5;
        if (!side) plain += (double)g->cost[i];
    }
    count[0] = fmax(count[0], 1);
    count[1] = fmax(count[1], 1);
    cues->apart = (float)(apart / (double)v->count);
    cues->unsure = (float)(unsure / (double)v->count);
    cues->away = (float)(sum[1] / count[1]);
    cues->near = (float)(sum[0] / count[0]);
    cues->plain = (float)(plain / count[0]);
    cues->dark = (float)(light[1] / count[1] - light[0] / count[0]);
}

status object_candidate_grow(object_ground *ground, const uint8_t *start, bool outside_hull, object_candidate *out)
{
    const size_t count = ground->view->count;
    *out = (object_candidate){.object = malloc(count)};
    growth g = {.ground = ground, .out = out, .outside_hull = outside_hull, .hull = malloc(4 * count)};
    g.cost = malloc(2 * count * sizeof *g.cost);
    g.toward = calloc(count, sizeof *g.toward);
    status s = OK;
    if (!out->object || !g.hull || !g.cost || !g.toward) s = fail(MERLIN_NO_MEMORY, "no memory to look for the object");
    if (s == OK) {
        g.hole = g.hull + count;
        g.new_hole = g.hole + count;
        g.before = g.new_hole + count;
        memset(g.hole, 0, count);
        memcpy(out->object, start, count);
    }
    bool changed = true;
    for (int round = 0; s == OK && changed && round < ROUNDS; round++) {
        memcpy(g.before, out->object, count);
        s = cut(&g);
        changed = memcmp(g.before, out->object, count) != 0;
    }
    if (s == OK) {
        add_outline(&g, &out->cues);
        add_place(&g, &out->cues);
        add_colors(&g, &out->cues);
    }
    free(g.hull);
    free(g.cost);
    free(g.toward);
    if (s != OK) object_candidate_free(out);
    return s;
}
