/* SPDX-License-Identifier: MIT */
#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "stereo/integrate/poisson_level.h"

/* Share of the strongest link of both its ends below which a link joins no nodes (docs/notes/depth_from_normals.md). */
static const float STRONG = 0.1f;
/* Divisor of coarse weights. A function that is constant over 2 × 2 blocks is stiffer than the smooth one that it
 * represents, twice in two dimensions; the divisor is nearly that, as in Braess 1995, "Towards algebraic multigrid for
 * elliptic problems of second order". */
static const float STIFFNESS = 1.8f;

/* ---- joining ---- */

/* Work on strips of the fine level, whose even numbers of rows share no block of the coarse one. */
typedef struct coarsening {
    poisson_level *fine;
    poisson_graph *coarse;
    int *block;               /* index of each fine node's block on the coarse level */
    float *strongest;         /* strongest link of each fine node */
    int made[POISSON_STRIPS]; /* number of coarse nodes in a strip, later of those before it */
    int *room;  /* upper bound of each coarse node's first link, with several fine ones counted separately */
    int *links; /* numbers of links */
    int *neighbour;
    float *weight;
} coarsening;

/* The links of a fine node. */
typedef struct links {
    int count;
    const int *node;
    const float *weight;
    int own_node[4];
    float own_weight[4];
} links;

static void add_link(links *l, int node, float weight)
{
    l->own_node[l->count] = node;
    l->own_weight[l->count++] = weight;
}

static void links_of(const poisson_level *l, int i, links *out)
{
    const poisson_grid *g = l->grid;
    if (!g) {
        int start = l->graph.start[i];
        out->count = l->graph.start[i + 1] - start;
        out->node = l->graph.neighbour + start;
        out->weight = l->graph.weight + start;
        return;
    }
    out->count = 0;
    for (int k = 0; k < 2; k++) {
        int next = g->next[k][i], previous = g->previous[k][i];
        if (next >= 0) add_link(out, next, g->weight[k][i]);
        if (previous >= 0) add_link(out, previous, g->weight[k][previous]);
    }
    out->node = out->own_node;
    out->weight = out->own_weight;
}

static void look_at_nodes(const coarsening *c, int begin, int end)
{
    int width = poisson_width(c->fine);
    for (int i = begin; i < end; i++) {
        int place = poisson_place(c->fine, i), row = place / width;
        links l;
        links_of(c->fine, i, &l);
        c->block[i] = row / 2 * c->coarse->width + (place - row * width) / 2;
        c->strongest[i] = 0;
        for (int k = 0; k < l.count; k++)
            c->strongest[i] = fmaxf(c->strongest[i], l.weight[k]);
    }
}

/* Joins nodes i and j if their link is strong. begin: the strip's first node; nodes before it belong to another thread.
 */
static void join(const coarsening *c, int begin, int i, int j, float weight)
{
    if (j < begin || j >= i || c->block[i] != c->block[j]) return;
    if (!(weight > STRONG * fminf(c->strongest[i], c->strongest[j]))) return;
    poisson_join(c->fine->parent, i, j);
}

/* Makes the least of the joined nodes their parent. */
static void join_strip(void *context, size_t strip)
{
    coarsening *c = context;
    int begin = c->fine->strip[strip], end = c->fine->strip[strip + 1], *parent = c->fine->parent;
    look_at_nodes(c, begin, end);
    for (int i = begin; i < end; i++) {
        links l;
        links_of(c->fine, i, &l);
        parent[i] = i;
        for (int k = 0; k < l.count; k++)
            join(c, begin, i, l.node[k], l.weight[k]);
    }
    c->made[strip] = 0;
    for (int i = begin; i < end; i++) {
        parent[i] = parent[parent[i]]; /* is a root, since smaller nodes already point to theirs */
        c->made[strip] += parent[i] == i;
    }
}

/* Replaces parents by the coarse nodes' indices. */
static void number_strip(void *context, size_t strip)
{
    coarsening *c = context;
    int number = c->made[strip], *parent = c->fine->parent;
    for (int i = c->fine->strip[strip]; i < c->fine->strip[strip + 1]; i++) {
        bool first = parent[i] == i;
        parent[i] = first ? number++ : parent[parent[i]];
        if (first) c->coarse->block[parent[i]] = c->block[i];
    }
}

/* ---- linking ---- */

static void make_room_strip(void *context, size_t strip)
{
    coarsening *c = context;
    const int *parent = c->fine->parent;
    for (int i = c->fine->strip[strip]; i < c->fine->strip[strip + 1]; i++) {
        links l;
        links_of(c->fine, i, &l);
        for (int k = 0; k < l.count; k++)
            c->room[parent[i]] += parent[l.node[k]] != parent[i];
    }
}

static void link_to(const coarsening *c, int node, int neighbour, float weight)
{
    int at = c->room[node], end = at + c->links[node];
    while (at < end && c->neighbour[at] != neighbour)
        at++;
    if (at == end) c->links[node]++;
    c->neighbour[at] = neighbour;
    c->weight[at] += weight;
}

static void link_strip(void *context, size_t strip)
{
    coarsening *c = context;
    const poisson_level *fine = c->fine;
    const int *parent = fine->parent;
    for (int i = fine->strip[strip]; i < fine->strip[strip + 1]; i++) {
        links l;
        links_of(fine, i, &l);
        c->coarse->pull[parent[i]] += fine->grid ? (double)fine->grid->pull[i] : fine->graph.pull[i];
        for (int k = 0; k < l.count; k++)
            if (parent[l.node[k]] != parent[i]) link_to(c, parent[i], parent[l.node[k]], l.weight[k] / STIFFNESS);
    }
}

static void pack_links(const coarsening *c)
{
    poisson_graph *g = c->coarse;
#pragma omp parallel for schedule(static)
    for (int i = 0; i < g->count; i++) {
        g->diagonal[i] = g->pull[i];
        for (int k = 0; k < c->links[i]; k++) {
            g->neighbour[g->start[i] + k] = c->neighbour[c->room[i] + k];
            g->weight[g->start[i] + k] = c->weight[c->room[i] + k];
            g->diagonal[i] += (double)c->weight[c->room[i] + k];
        }
    }
}

/* Computes running sums of the counts before each entry; returns the total. */
static int add_up(const int *count, int n, int *before)
{
    int sum = 0;
    for (int i = 0; i < n; i++) {
        int here = count[i];
        before[i] = sum;
        sum += here;
    }
    return sum;
}

static status no_memory(const coarsening *c)
{
    return fail(MERLIN_NO_MEMORY, "no memory to integrate %d pixels", c->fine->count);
}

static status join_nodes(coarsening *c)
{
    size_t n = (size_t)c->fine->count;
    c->fine->parent = memory_new(n * sizeof *c->fine->parent);
    c->block = memory_new(n * sizeof *c->block);
    c->strongest = memory_new(n * sizeof *c->strongest);
    if (!c->fine->parent || !c->block || !c->strongest) return no_memory(c);
    parallel_for(POISSON_STRIPS, join_strip, c);
    c->coarse->count = add_up(c->made, POISSON_STRIPS, c->made);
    status s = poisson_graph_allocate(c->coarse);
    if (s == OK) parallel_for(POISSON_STRIPS, number_strip, c);
    return s;
}

static status link_nodes(coarsening *c)
{
    poisson_graph *g = c->coarse;
    size_t m = (size_t)g->count;
    c->room = memory_new(m * sizeof *c->room);
    c->links = memory_new(m * sizeof *c->links);
    if (!c->room || !c->links) return no_memory(c);
    parallel_for(POISSON_STRIPS, make_room_strip, c);
    size_t most = (size_t)add_up(c->room, g->count, c->room);
    c->neighbour = memory_new(most * sizeof *c->neighbour);
    c->weight = memory_new(most * sizeof *c->weight);
    if (!c->neighbour || !c->weight) return no_memory(c);
    parallel_for(POISSON_STRIPS, link_strip, c);
    g->start[g->count] = add_up(c->links, g->count, g->start);
    status s = poisson_graph_allocate_links(g, g->start[g->count]);
    if (s == OK) pack_links(c);
    return s;
}

status poisson_level_coarsen(poisson_level *fine, poisson_level *coarse)
{
    *coarse = (poisson_level){0};
    coarse->graph = (poisson_graph){.width = (poisson_width(fine) + 1) / 2, .height = (poisson_height(fine) + 1) / 2};
    coarsening c = {.fine = fine, .coarse = &coarse->graph};
    status s = join_nodes(&c);
    if (s == OK) s = link_nodes(&c);
    memory_free(c.block);
    memory_free(c.strongest);
    memory_free(c.room);
    memory_free(c.links);
    memory_free(c.neighbour);
    memory_free(c.weight);
    coarse->count = coarse->graph.count;
    size_t m = (size_t)coarse->count;
    if (s == OK) s = poisson_level_prepare(coarse);
    if (s != OK) return s;
    coarse->x = memory_new(m * sizeof *coarse->x);
    coarse->b = memory_new(m * sizeof *coarse->b);
    return coarse->x && coarse->b ? OK : no_memory(&c);
}
