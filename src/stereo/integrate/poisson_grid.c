/* SPDX-License-Identifier: MIT */
#include <stdbool.h>

#include "base/memory.h"
#include "stereo/integrate/poisson_level.h"

static status allocate(poisson_grid *g)
{
    size_t n = (size_t)g->count;
    g->pixel = memory_new(n * sizeof *g->pixel);
    g->piece = memory_new(n * sizeof *g->piece);
    g->pull = memory_new(n * sizeof *g->pull);
    g->pulled_to = memory_new(n * sizeof *g->pulled_to);
    bool complete = g->pixel && g->piece && g->pull && g->pulled_to;
    for (int k = 0; k < 2; k++) {
        g->next[k] = memory_new(n * sizeof **g->next);
        g->previous[k] = memory_new(n * sizeof **g->previous);
        g->weight[k] = memory_new(n * sizeof **g->weight);
        g->target[k] = memory_new(n * sizeof **g->target);
        complete = complete && g->next[k] && g->previous[k] && g->weight[k] && g->target[k];
    }
    return complete ? OK : fail(MERLIN_NO_MEMORY, "no memory to integrate %d pixels", g->count);
}

static void link_neighbours(poisson_grid *g)
{
#pragma omp parallel for schedule(static)
    for (int i = 0; i < g->count; i++) {
        int x = g->pixel[i] % g->width, y = g->pixel[i] / g->width;
        const int *at = g->node + g->pixel[i];
        g->next[0][i] = x + 1 < g->width ? at[1] : -1;
        g->next[1][i] = y + 1 < g->height ? at[g->width] : -1;
        g->previous[0][i] = x > 0 ? at[-1] : -1;
        g->previous[1][i] = y > 0 ? at[-g->width] : -1;
        for (int k = 0; k < 2; k++)
            g->weight[k][i] = g->next[k][i] >= 0 ? 1.0f : 0.0f;
    }
}

/* Numbers the connected pieces by union-find: a node joins the pieces of its neighbours before it. */
static void number_pieces(poisson_grid *g)
{
    int *piece = g->piece;
    for (int i = 0; i < g->count; i++) {
        piece[i] = i;
        for (int k = 0; k < 2; k++)
            if (g->previous[k][i] >= 0) poisson_join(piece, i, g->previous[k][i]);
    }
    for (int i = 0; i < g->count; i++)
        piece[i] = piece[piece[i]]; /* is a root, since smaller nodes already point to theirs */
    for (int i = 0; i < g->count; i++)
        piece[i] = piece[i] == i ? g->pieces++ : piece[piece[i]];
}

/* Numbers and links a grid whose width, height, count and node (≥ 0 inside) are set. */
static status number_and_link(poisson_grid *g)
{
    size_t pixels = (size_t)g->width * (size_t)g->height;
    status s = allocate(g);
    if (s != OK) return s;
    int i = 0;
    for (size_t p = 0; p < pixels; p++) {
        if (g->node[p] < 0) continue;
        g->pixel[i] = (int)p;
        g->node[p] = i++;
    }
    link_neighbours(g);
    number_pieces(g);
    return OK;
}

status poisson_grid_new(const img *mask, poisson_grid *g)
{
    *g = (poisson_grid){.width = mask->width, .height = mask->height};
    size_t pixels = (size_t)mask->width * (size_t)mask->height;
    g->node = memory_new(pixels * sizeof *g->node);
    if (!g->node) return fail(MERLIN_NO_MEMORY, "no memory to integrate %zu pixels", pixels);
    for (size_t p = 0; p < pixels; p++) {
        bool inside = mask->data[p * (size_t)mask->channels] > 0.5f;
        g->node[p] = inside ? 0 : -1;
        g->count += inside;
    }
    status s =
        g->count ? number_and_link(g) : fail(MERLIN_BAD_INPUT, "the mask is empty: there is nothing to integrate");
    if (s != OK) poisson_grid_free(g);
    return s;
}

void poisson_grid_free(poisson_grid *g)
{
    memory_free(g->node);
    memory_free(g->pixel);
    memory_free(g->piece);
    memory_free(g->pull);
    memory_free(g->pulled_to);
    for (int k = 0; k < 2; k++) {
        memory_free(g->next[k]);
        memory_free(g->previous[k]);
        memory_free(g->weight[k]);
        memory_free(g->target[k]);
    }
    *g = (poisson_grid){0};
}
