/* SPDX-License-Identifier: MIT */
#include "stereo/integrate/poisson_graph.h"

#include "base/memory.h"

static status no_memory(const poisson_graph *g)
{
    return fail(MERLIN_NO_MEMORY, "no memory to integrate %d pixels", g->count);
}

status poisson_graph_allocate(poisson_graph *g)
{
    size_t n = (size_t)g->count;
    g->block = memory_new(n * sizeof *g->block);
    g->start = memory_new((n + 1) * sizeof *g->start);
    g->pull = memory_new(n * sizeof *g->pull);
    g->diagonal = memory_new(n * sizeof *g->diagonal);
    return g->block && g->start && g->pull && g->diagonal ? OK : no_memory(g);
}

status poisson_graph_allocate_links(poisson_graph *g, int links)
{
    g->neighbour = memory_new((size_t)links * sizeof *g->neighbour);
    g->weight = memory_new((size_t)links * sizeof *g->weight);
    return g->neighbour && g->weight ? OK : no_memory(g);
}

void poisson_graph_free(poisson_graph *g)
{
    memory_free(g->block);
    memory_free(g->start);
    memory_free(g->pull);
    memory_free(g->diagonal);
    memory_free(g->neighbour);
    memory_free(g->weight);
    *g = (poisson_graph){0};
}

static void link_to(poisson_graph *g, int node, float weight, int *at)
{
    if (node < 0) return;
    g->neighbour[*at] = node;
    g->weight[(*at)++] = weight;
}

status poisson_graph_of(const poisson_grid *grid, poisson_graph *out)
{
    *out = (poisson_graph){.count = grid->count, .width = grid->width, .height = grid->height};
    int at = 0;
    status s = poisson_graph_allocate(out);
    if (s == OK) s = poisson_graph_allocate_links(out, 4 * grid->count);
    for (int i = 0; s == OK && i < grid->count; i++) {
        int left = grid->previous[0][i], above = grid->previous[1][i];
        out->block[i] = grid->pixel[i];
        out->pull[i] = (double)grid->pull[i];
        out->diagonal[i] = poisson_grid_diagonal(grid, i);
        link_to(out, above, above < 0 ? 0 : grid->weight[1][above], &at);
        link_to(out, left, left < 0 ? 0 : grid->weight[0][left], &at);
        link_to(out, grid->next[0][i], grid->weight[0][i], &at);
        link_to(out, grid->next[1][i], grid->weight[1][i], &at);
        out->start[i + 1] = at;
    }
    if (s != OK) poisson_graph_free(out);
    return s;
}
