/* SPDX-License-Identifier: MIT */
#include "estimate/object/grid_cut.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Link of a pixel to its tree: a direction, or one of these. */
enum { AT_TERMINAL = GRID_DIRECTIONS, NO_PARENT, ORPHAN };
enum { NO_TREE, SOURCE, SINK };
#define NONE UINT32_MAX

/* Work on the grid with a border of unused pixels, one wide, so that every pixel of the picture has eight neighbours.
 */
typedef struct cut {
    int32_t *rest;                 /* residual capacity of terminal links: above 0 to the source, below to the sink */
    int32_t *tie[GRID_DIRECTIONS]; /* residual capacity of ties */
    uint8_t *tree, *parent;
    uint32_t *stamp, *distance; /* distance to the terminal, and the time at which it was determined */
    uint32_t *queue;            /* linked list of active pixels; NONE: not in it */
    uint32_t *orphans;
    uint32_t first, last, orphan_count, orphan_room, time;
    ptrdiff_t step[GRID_DIRECTIONS];
    size_t stride;
} cut;

status grid_cut_new(grid_cut *out, int width, int height)
{
    size_t count = (size_t)width * (size_t)height;
    *out = (grid_cut){.width = width, .height = height};
    int32_t *memory = calloc(count, (GRID_DIRECTIONS / 2 + 1) * sizeof *memory + 1);
    if (!memory) return fail(MERLIN_NO_MEMORY, "no memory to look for the object");
    out->memory = out->toward = memory;
    for (int d = 0; d < GRID_DIRECTIONS; d += 2)
        out->tie[d] = memory + (size_t)(1 + d / 2) * count;
    out->free = (uint8_t *)(memory + (GRID_DIRECTIONS / 2 + 1) * count);
    memset(out->free, 1, count);
    return OK;
}

void grid_cut_free(grid_cut *g)
{
    free(g->memory);
    free(g->work);
    *g = (grid_cut){0};
}

/* ---- the work's memory ---- */

/* Allocates one block of memory for all cuts of a grid, as new pages cost as much as a small cut. */
static status cut_new(grid_cut *g, cut *c)
{
    size_t count = ((size_t)g->width + 2) * ((size_t)g->height + 2);
    const size_t bytes = (1 + GRID_DIRECTIONS + 3) * sizeof *c->rest + 2;
    *c = (cut){.stride = (size_t)g->width + 2, .first = NONE, .last = NONE};
    if (g->work)
        memset(g->work, 0, count * bytes);
    else
        g->work = calloc(count, bytes);
    if (!g->work) return fail(MERLIN_NO_MEMORY, "no memory to look for the object");
    c->rest = g->work;
    for (int d = 0; d < GRID_DIRECTIONS; d++)
        c->tie[d] = c->rest + (size_t)(1 + d) * count;
    c->stamp = (uint32_t *)(c->rest + (size_t)(1 + GRID_DIRECTIONS) * count);
    c->distance = c->stamp + count;
    c->queue = c->distance + count;
    c->tree = (uint8_t *)(c->queue + count);
    c->parent = c->tree + count;
    memset(c->parent, NO_PARENT, count);
    memset(c->queue, 0xff, count * sizeof *c->queue);
    ptrdiff_t row = (ptrdiff_t)c->stride;
    const ptrdiff_t steps[GRID_DIRECTIONS] = {1, -1, row, -row, row + 1, -row - 1, row - 1, 1 - row};
    memcpy(c->step, steps, sizeof steps);
    return OK;
}

static uint32_t neighbour(const cut *c, uint32_t at, int direction)
{
    return (uint32_t)((ptrdiff_t)at + c->step[direction]);
}

/* ---- pixels that may grow, first in, first out ---- */

/* Appends a pixel to the queue; the last one points to itself. */
static void make_active(cut *c, uint32_t at)
{
    if (c->queue[at] != NONE) return;
    if (c->last == NONE)
        c->first = at;
    else
        c->queue[c->last] = at;
    c->last = at;
    c->queue[at] = at;
}

static uint32_t next_active(cut *c)
{
    while (c->first != NONE) {
        uint32_t at = c->first;
        bool is_last = c->queue[at] == at;
        c->first = is_last ? NONE : c->queue[at];
        if (is_last) c->last = NONE;
        c->queue[at] = NONE;
        if (c->parent[at] != NO_PARENT) return at;
    }
    return NONE;
}

static status make_orphan(cut *c, uint32_t at)
{
    if (c->orphan_count == c->orphan_room) {
        uint32_t room = c->orphan_room ? 2 * c->orphan_room : 1024;
        uint32_t *larger = realloc(c->orphans, room * sizeof *larger);
        if (!larger) return fail(MERLIN_NO_MEMORY, "no memory to look for the object");
        c->orphans = larger;
        c->orphan_room = room;
    }
    c->parent[at] = ORPHAN;
    c->orphans[c->orphan_count++] = at;
    return OK;
}

/* ---- the graph ---- */

/* Sets the ties; those to pixels that are not free become links to the terminal of their side. */
static void tie_pixels(const grid_cut *g, const uint8_t *object, cut *c)
{
    for (int d = 0; d < GRID_DIRECTIONS; d += 2) {
        for (size_t i = 0; i < (size_t)g->width * (size_t)g->height; i++) {
            size_t j = grid_beside(g->width, g->height, i, d);
            int32_t weight = j == SIZE_MAX ? 0 : g->tie[d][i];
            if (!weight || (!g->free[i] && !g->free[j])) continue;
            size_t width = (size_t)g->width, a = (i / width + 1) * c->stride + i % width + 1;
            size_t b = (size_t)((ptrdiff_t)a + c->step[d]);
            if (g->free[i] && g->free[j]) {
                c->tie[d][a] = c->tie[d ^ 1][b] = weight;
            } else {
                size_t fixed = g->free[i] ? j : i;
                c->rest[g->free[i] ? a : b] += object[fixed] ? weight : -weight;
            }
        }
    }
}

static void plant_trees(const grid_cut *g, const uint8_t *object, cut *c)
{
    tie_pixels(g, object, c);
    for (int y = 0; y < g->height; y++)
        for (int x = 0; x < g->width; x++) {
            size_t i = (size_t)y * (size_t)g->width + (size_t)x;
            uint32_t a = (uint32_t)((size_t)(y + 1) * c->stride + (size_t)x + 1);
            if (!g->free[i]) continue;
            c->rest[a] += g->toward[i];
            if (c->rest[a] == 0) continue;
            c->tree[a] = c->rest[a] > 0 ? SOURCE : SINK;
            c->parent[a] = AT_TERMINAL;
            c->distance[a] = 1;
            make_active(c, a);
        }
}

/* ---- growth ---- */

/* Returns the residual capacity, away from the source, of the tie between a pixel and its parent or child in a
 * direction. */
static int32_t *tie_from(const cut *c, uint32_t at, int direction, int tree)
{
    return tree == SOURCE ? &c->tie[direction][at] : &c->tie[direction ^ 1][neighbour(c, at, direction)];
}

/* Adds free neighbours to a pixel's tree. Returns the direction in which it meets the other tree, or GRID_DIRECTIONS.
 */
static int grow(cut *c, uint32_t at)
{
    const uint8_t mine = c->tree[at];
    for (int d = 0; d < GRID_DIRECTIONS; d++) {
        if (!*tie_from(c, at, d, mine)) continue;
        uint32_t to = neighbour(c, at, d);
        if (c->parent[to] == NO_PARENT) {
            c->tree[to] = mine;
            c->parent[to] = (uint8_t)(d ^ 1);
            c->stamp[to] = c->stamp[at];
            c->distance[to] = c->distance[at] + 1;
            make_active(c, to);
        } else if (c->tree[to] != mine) {
            return d;
        } else if (c->stamp[to] <= c->stamp[at] && c->distance[to] > c->distance[at] + 1) {
            c->parent[to] = (uint8_t)(d ^ 1);
            c->stamp[to] = c->stamp[at];
            c->distance[to] = c->distance[at] + 1;
        }
    }
    return GRID_DIRECTIONS;
}

/* ---- augmentation ---- */

/* Returns the least capacity on the path from a pixel to its tree's terminal, at most `most`. */
static int32_t room_to_terminal(const cut *c, uint32_t at, int32_t most)
{
    const int tree = c->tree[at];
    while (c->parent[at] != AT_TERMINAL) {
        int d = c->parent[at];
        uint32_t up = neighbour(c, at, d);
        int32_t room = *tie_from(c, up, d ^ 1, tree);
        if (room < most) most = room;
        at = up;
    }
    int32_t room = tree == SOURCE ? c->rest[at] : -c->rest[at];
    return room < most ? room : most;
}

static status push_to_terminal(cut *c, uint32_t at, int32_t flow)
{
    const int tree = c->tree[at];
    status s = OK;
    while (c->parent[at] != AT_TERMINAL) {
        int d = c->parent[at];
        uint32_t up = neighbour(c, at, d);
        *tie_from(c, up, d ^ 1, tree) -= flow;
        *tie_from(c, at, d, tree) += flow;
        if (!*tie_from(c, up, d ^ 1, tree) && s == OK) s = make_orphan(c, at);
        at = up;
    }
    c->rest[at] += tree == SOURCE ? -flow : flow;
    return !c->rest[at] && s == OK ? make_orphan(c, at) : s;
}

static status augment(cut *c, uint32_t at, int direction)
{
    uint32_t to = neighbour(c, at, direction);
    const int mine = c->tree[at];
    int32_t *tie = tie_from(c, at, direction, mine), flow = *tie;
    flow = room_to_terminal(c, at, flow);
    flow = room_to_terminal(c, to, flow);
    *tie -= flow;
    *tie_from(c, to, direction ^ 1, mine) += flow;
    status s = push_to_terminal(c, at, flow);
    return s == OK ? push_to_terminal(c, to, flow) : s;
}

/* ---- adoption ---- */

/* Returns the number of steps from a pixel to its terminal, or UINT32_MAX if its path ends at an orphan. The result is
 * stored for the current time. */
static uint32_t distance_to_terminal(cut *c, uint32_t start)
{
    uint32_t steps = 0, known = 1, at = start;
    for (; c->stamp[at] != c->time && c->parent[at] != AT_TERMINAL; steps++) {
        if (c->parent[at] >= NO_PARENT) return UINT32_MAX;
        at = neighbour(c, at, c->parent[at]);
    }
    if (c->stamp[at] == c->time) known = c->distance[at];
    at = start;
    for (uint32_t left = steps + known; left >= known; left--) {
        c->stamp[at] = c->time;
        c->distance[at] = left;
        if (left > known) at = neighbour(c, at, c->parent[at]);
    }
    return steps + known;
}

/* Gives an orphan the parent nearest to the terminal, if there is one. */
static bool find_parent(cut *c, uint32_t at)
{
    uint32_t least = UINT32_MAX;
    for (int d = 0; d < GRID_DIRECTIONS; d++) {
        uint32_t up = neighbour(c, at, d);
        if (c->parent[up] == NO_PARENT || c->tree[up] != c->tree[at]) continue;
        if (!*tie_from(c, up, d ^ 1, c->tree[at])) continue;
        uint32_t distance = distance_to_terminal(c, up);
        if (distance >= least) continue;
        least = distance;
        c->parent[at] = (uint8_t)d;
    }
    if (least == UINT32_MAX) return false;
    c->stamp[at] = c->time;
    c->distance[at] = least + 1;
    return true;
}

/* Frees a pixel that has no path to its terminal any more; its children become orphans. */
static status set_free(cut *c, uint32_t at)
{
    const uint8_t tree = c->tree[at];
    status s = OK;
    c->parent[at] = NO_PARENT;
    for (int d = 0; d < GRID_DIRECTIONS && s == OK; d++) {
        uint32_t to = neighbour(c, at, d);
        if (c->parent[to] == NO_PARENT || c->tree[to] != tree) continue;
        if (*tie_from(c, to, d ^ 1, tree)) make_active(c, to);
        if (c->parent[to] == (d ^ 1)) s = make_orphan(c, to);
    }
    return s;
}

static status adopt(cut *c)
{
    status s = OK;
    c->time++;
    while (c->orphan_count && s == OK) {
        uint32_t at = c->orphans[--c->orphan_count];
        if (!find_parent(c, at)) s = set_free(c, at);
    }
    return s;
}

static status push_all(cut *c)
{
    status s = OK;
    for (uint32_t at; s == OK && (at = next_active(c)) != NONE;) {
        int direction;
        while (s == OK && c->parent[at] != NO_PARENT && (direction = grow(c, at)) != GRID_DIRECTIONS) {
            s = augment(c, at, direction);
            if (s == OK) s = adopt(c);
        }
    }
    return s;
}

status grid_cut_solve(grid_cut *g, uint8_t *object)
{
    cut c;
    status s = cut_new(g, &c);
    if (s != OK) return s;
    plant_trees(g, object, &c);
    s = push_all(&c);
    for (int y = 0; s == OK && y < g->height; y++)
        for (int x = 0; x < g->width; x++) {
            size_t i = (size_t)y * (size_t)g->width + (size_t)x;
            size_t a = (size_t)(y + 1) * c.stride + (size_t)x + 1;
            if (g->free[i]) object[i] = c.parent[a] != NO_PARENT && c.tree[a] == SOURCE;
        }
    free(c.orphans);
    return s;
}
