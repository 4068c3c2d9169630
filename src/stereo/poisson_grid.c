#include <stdlib.h>

#include "stereo/poisson.h"
#include "stereo/poisson_level.h"

status poisson_grid_allocate(poisson_grid *g)
{
    size_t n = (size_t)g->count;
    g->pixel = calloc(n, sizeof *g->pixel);
    g->pull = calloc(n, sizeof *g->pull);
    g->pulled_to = calloc(n, sizeof *g->pulled_to);
    bool complete = g->pixel && g->pull && g->pulled_to;
    for (int k = 0; k < 2; k++) {
        g->next[k] = calloc(n, sizeof **g->next);
        g->previous[k] = calloc(n, sizeof **g->previous);
        g->weight[k] = malloc(n * sizeof **g->weight);
        g->target[k] = calloc(n, sizeof **g->target);
        complete = complete && g->next[k] && g->previous[k] && g->weight[k] && g->target[k];
    }
    return complete ? OK : fail(ERROR_MEMORY, "no memory to integrate %d pixels", g->count);
}

static void link_neighbours(poisson_grid *g)
{
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

/* Numbers and links a grid whose width, height, count and node (≥ 0 inside) are set. */
static status number_and_link(poisson_grid *g)
{
    size_t pixels = (size_t)g->width * (size_t)g->height;
    status s = poisson_grid_allocate(g);
    if (s != OK) return s;
    int i = 0;
    for (size_t p = 0; p < pixels; p++) {
        if (g->node[p] < 0) continue;
        g->pixel[i] = (int)p;
        g->node[p] = i++;
    }
    link_neighbours(g);
    return OK;
}

status poisson_grid_new(const img *mask, poisson_grid *g)
{
    *g = (poisson_grid){.width = mask->width, .height = mask->height};
    size_t pixels = (size_t)mask->width * (size_t)mask->height;
    g->node = calloc(pixels, sizeof *g->node);
    if (!g->node) return fail(ERROR_MEMORY, "no memory to integrate %zu pixels", pixels);
    for (size_t p = 0; p < pixels; p++) {
        bool inside = mask->data[p * (size_t)mask->channels] > 0.5f;
        g->node[p] = inside ? 0 : -1;
        g->count += inside;
    }
    status s = g->count ? number_and_link(g) : fail(ERROR_INPUT, "the mask is empty: there is nothing to integrate");
    if (s != OK) poisson_grid_free(g);
    return s;
}

void poisson_grid_free(poisson_grid *g)
{
    free(g->node);
    free(g->pixel);
    free(g->pull);
    free(g->pulled_to);
    for (int k = 0; k < 2; k++) {
        free(g->next[k]);
        free(g->previous[k]);
        free(g->weight[k]);
        free(g->target[k]);
    }
    *g = (poisson_grid){0};
}

/* Gives every node reachable from `from` its number; stack has room for count entries, each node enters once. */
static void flood(const poisson_grid *g, int from, int number, int *piece, int *stack)
{
    int depth = 0;
    stack[depth++] = from;
    piece[from] = number;
    while (depth > 0) {
        int i = stack[--depth];
        int around[4] = {g->next[0][i], g->next[1][i], g->previous[0][i], g->previous[1][i]};
        for (int k = 0; k < 4; k++) {
            if (around[k] < 0 || piece[around[k]] >= 0) continue;
            piece[around[k]] = number;
            stack[depth++] = around[k];
        }
    }
}

status poisson_pieces(const poisson_grid *g, int *piece, int *piece_count)
{
    int *stack = malloc((size_t)g->count * sizeof *stack);
    if (!stack) return fail(ERROR_MEMORY, "no memory to integrate %d pixels", g->count);
    for (int i = 0; i < g->count; i++)
        piece[i] = -1;
    *piece_count = 0;
    for (int i = 0; i < g->count; i++)
        if (piece[i] < 0) flood(g, i, (*piece_count)++, piece, stack);
    free(stack);
    return OK;
}
