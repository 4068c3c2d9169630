/* SPDX-License-Identifier: MIT */
/* Levels of the Poisson solver: a grid, successively smaller graphs, and a factorization of the smallest. Internal. */
#ifndef MERLIN_STEREO_INTEGRATE_POISSON_LEVEL_H
#define MERLIN_STEREO_INTEGRATE_POISSON_LEVEL_H

#include <stdbool.h>

#include "stereo/integrate/poisson_factor.h"
#include "stereo/integrate/poisson_graph.h"

/* Number of strips of whole rows in which nodes are processed, so that sums do not depend on the number of threads. */
enum { POISSON_STRIPS = 64 };

/* A level: a grid, or a graph. */
typedef struct poisson_level {
    const poisson_grid *grid; /* grid, on the finest level only; NULL: the graph */
    poisson_graph graph;
    int count;
    int *parent; /* count: the node's parent on the next level */
    bool *odd;   /* count: whether its block is black on a checkerboard; no two black blocks are neighbours */
    int strip[POISSON_STRIPS + 1]; /* first node of each strip; a strip has an even number of rows */
    double *x, *b;                 /* correction and right-hand side; NULL on the finest level */
} poisson_level;

/* Returns the width of the grid, or in blocks. */
static inline int poisson_width(const poisson_level *l)
{
    return l->grid ? l->grid->width : l->graph.width;
}

static inline int poisson_height(const poisson_level *l)
{
    return l->grid ? l->grid->height : l->graph.height;
}

/* Returns y × width + x. */
static inline int poisson_place(const poisson_level *l, int i)
{
    return l->grid ? l->grid->pixel[i] : l->graph.block[i];
}

/* Sets odd and strip, given grid or graph and count. */
status poisson_level_prepare(poisson_level *l);
/* Sets fine->parent, and makes the prepared graph of half the size: nodes of a block that are joined by strong links
 * within it become one; parts separated by a jump or slit stay separate. Call poisson_level_free whatever it returns.
 */
status poisson_level_coarsen(poisson_level *fine, poisson_level *coarse);
void poisson_level_free(poisson_level *l);

/* Returns the operator's diagonal at node i. */
static inline double poisson_diagonal(const poisson_level *l, int i)
{
    return l->grid ? poisson_grid_diagonal(l->grid, i) : l->graph.diagonal[i];
}

/* Returns Σ weight × x over the neighbours of node i. */
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

/* Returns b − A x at node i. */
static inline double poisson_residual(const poisson_level *l, int i, const double *b, const double *x)
{
    return b[i] - poisson_diagonal(l, i) * x[i] + poisson_around(l, i, x);
}

/* Returns the root of i by union-find, where nodes point to smaller ones of their set or to themselves, and shortens
 * the path. */
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

/* Multigrid: a W-cycle over the levels, with a factorization of the last. */
typedef struct poisson_stack {
    poisson_level levels[POISSON_LEVELS];
    int depth;
    poisson_factor *factor; /* factorization of the last level */
} poisson_stack;

/* Builds the levels. Call poisson_stack_free whatever it returns. */
status poisson_stack_new(const poisson_grid *g, poisson_stack *s);
void poisson_stack_free(poisson_stack *s);
/* Computes x, from zero, as an approximate solution of A x = b on the finest level; symmetric, so that it can
 * precondition conjugate gradients. */
status poisson_stack_cycle(poisson_stack *s, const double *b, double *x);

#endif
