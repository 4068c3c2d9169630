/* SPDX-License-Identifier: MIT */
/* The Poisson solver's levels: a grid, ever smaller graphs over it, and a factorization of the smallest. Internal. */
#ifndef MERLIN_STEREO_INTEGRATE_POISSON_LEVEL_H
#define MERLIN_STEREO_INTEGRATE_POISSON_LEVEL_H

#include <stdbool.h>

#include "stereo/integrate/poisson_factor.h"
#include "stereo/integrate/poisson_graph.h"

/* Nodes are worked on in strips of whole rows, whichever thread has which: sums do not depend on their number. */
enum { POISSON_STRIPS = 64 };

/* A grid, or a graph over it. */
typedef struct poisson_level {
    const poisson_grid *grid; /* of the finest level alone; NULL: the graph */
    poisson_graph graph;
    int count;
    int *parent;                   /* count: node of the next level */
    bool *odd;                     /* count: of the chessboard's black blocks, none of which lies beside another */
    int strip[POISSON_STRIPS + 1]; /* first nodes; a strip has an even number of rows */
    double *x, *b;                 /* correction and right-hand side; the finest level has none */
} poisson_level;

/* Of the grid, or in blocks. */
static inline int poisson_width(const poisson_level *l)
{
    return l->grid ? l->grid->width : l->graph.width;
}

static inline int poisson_height(const poisson_level *l)
{
    return l->grid ? l->grid->height : l->graph.height;
}

/* y × width + x */
static inline int poisson_place(const poisson_level *l, int i)
{
    return l->grid ? l->grid->pixel[i] : l->graph.block[i];
}

/* odd and strip, from grid or graph and count. */
status poisson_level_prepare(poisson_level *l);
/* fine->parent and the graph of half the size, prepared: nodes of a block that strong links join within it become one.
 * What a jump or a slit parts stays apart. Call poisson_level_free whatever it returns. */
status poisson_level_coarsen(poisson_level *fine, poisson_level *coarse);
void poisson_level_free(poisson_level *l);

/* The operator's diagonal at node i. */
static inline double poisson_diagonal(const poisson_level *l, int i)
{
    return l->grid ? poisson_grid_diagonal(l->grid, i) : l->graph.diagonal[i];
}

/* Σ weight × x over the neighbours of node i. */
static inline double poisson_around(const poisson_level *l, int i, const double *x)
{
    const poisson_grid *g = l->grid;
    double sum = 0;
    for (int k = 0; g && k < 2; k++) {
        int next = g->next[k][i], previous = g->previous[k][i];
        if (next >= 0) sum += (double)g->weight[k][i] * x[next];
        if (previous >= 0) sum += (double)g->weight[k][previous] * x[previous];
    }
    if (g) return sum;
    for (int at = l->graph.start[i]; at < l->graph.start[i + 1]; at++)
        sum += (double)l->graph.weight[at] * x[l->graph.neighbour[at]];
    return sum;
}

/* b − A x at node i. */
static inline double poisson_residual(const poisson_level *l, int i, const double *b, const double *x)
{
    return b[i] - poisson_diagonal(l, i) * x[i] + poisson_around(l, i, x);
}

/* Union-find over nodes that point to smaller ones of their set, or to themselves. The way to the least one becomes
 * shorter. */
static inline int poisson_root(int *towards, int i)
{
    while (towards[i] != i)
        i = towards[i] = towards[towards[i]];
    return i;
}

static inline void poisson_join(int *towards, int i, int j)
{
    int one = poisson_root(towards, i), other = poisson_root(towards, j);
    towards[one > other ? one : other] = one < other ? one : other;
}

enum { POISSON_LEVELS = 20 };

/* Multigrid: a W-cycle over the levels, the last one factorized. */
typedef struct poisson_stack {
    poisson_level levels[POISSON_LEVELS];
    int depth;
    poisson_factor *factor; /* of the last level */
} poisson_stack;

/* Call poisson_stack_free whatever it returns. */
status poisson_stack_new(const poisson_grid *g, poisson_stack *s);
void poisson_stack_free(poisson_stack *s);
/* x, from zero, toward A x = b on the finest level; symmetric, fit to precondition conjugate gradients. */
status poisson_stack_cycle(poisson_stack *s, const double *b, double *x);

#endif
