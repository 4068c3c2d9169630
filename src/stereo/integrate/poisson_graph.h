/* SPDX-License-Identifier: MIT */
/* The levels of the Poisson solver above its grid: blocks of pixels as nodes, with links between them. Internal. */
#ifndef MERLIN_STEREO_INTEGRATE_POISSON_GRAPH_H
#define MERLIN_STEREO_INTEGRATE_POISSON_GRAPH_H

#include "stereo/integrate/poisson.h"

/* The operator's diagonal at an unknown of the grid. */
static inline double poisson_grid_diagonal(const poisson_grid *g, int i)
{
    double d = (double)g->pull[i] + (double)g->weight[0][i] + (double)g->weight[1][i];
    for (int k = 0; k < 2; k++)
        if (g->previous[k][i] >= 0) d += (double)g->weight[k][g->previous[k][i]];
    return d;
}

/* A node stands for pixels of one block, of 2^k × 2^k of them; a block may have several. Links lead from a block to
 * those beside, above and below it; weak ones, at a jump, also from node to node of one block. */
typedef struct poisson_graph {
    int count, width, height; /* width, height: in blocks */
    int *block;               /* count: y × width + x, row by row, in a row in any order */
    int *start;               /* count + 1: where a node's links begin */
    int *neighbour;           /* start[count] */
    float *weight;            /* start[count]: of the link */
    double *pull, *diagonal;  /* count */
} poisson_graph;

/* Makes the graph of a grid, one node a pixel. */
status poisson_graph_of(const poisson_grid *g, poisson_graph *out);
void poisson_graph_free(poisson_graph *g);
/* Allocates arrays of count entries, zero; links are another matter. */
status poisson_graph_allocate(poisson_graph *g);
status poisson_graph_allocate_links(poisson_graph *g, int links);

#endif
