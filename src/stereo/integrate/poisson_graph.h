/* SPDX-License-Identifier: MIT */
/* Graphs of the Poisson solver's levels above its grid: blocks of pixels as nodes, with links between them. Internal.
 */
#ifndef MERLIN_STEREO_INTEGRATE_POISSON_GRAPH_H
#define MERLIN_STEREO_INTEGRATE_POISSON_GRAPH_H

#include "stereo/integrate/poisson.h"

/* Returns the operator's diagonal at an unknown of the grid. */
static inline double poisson_grid_diagonal(const poisson_grid *g, int i)
{
    double d = (double)g->pull[i] + (double)g->weight[0][i] + (double)g->weight[1][i];
    for (int k = 0; k < 2; k++)
        if (g->previous[k][i] >= 0) d += (double)g->weight[k][g->previous[k][i]];
    return d;
}

/* Nodes and links. A node stands for pixels of one block of 2^k × 2^k; a block may have several nodes. Links lead to
 * the blocks to the left and right, above and below; weak ones, at a jump, also between nodes of one block. */
typedef struct poisson_graph {
    int count, width, height; /* width and height in blocks */
    int *block;               /* count: y × width + x, row by row, within a row in any order */
    int *start;               /* count + 1: index of a node's first link */
    int *neighbour;           /* start[count]: node at the other end */
    float *weight;            /* start[count]: weight of the link */
    double *pull, *diagonal;  /* count each */
} poisson_graph;

/* Makes the graph of a grid, with one node per pixel. */
status poisson_graph_of(const poisson_grid *g, poisson_graph *out);
void poisson_graph_free(poisson_graph *g);
/* Allocates the arrays of count entries, zeroed, but not those of links. */
status poisson_graph_allocate(poisson_graph *g);
status poisson_graph_allocate_links(poisson_graph *g, int links);

#endif
