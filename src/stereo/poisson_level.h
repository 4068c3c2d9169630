/* What the Poisson solver is made of: grids of falling size and a factorization of the smallest. Internal. */
#ifndef MERLIN_STEREO_POISSON_LEVEL_H
#define MERLIN_STEREO_POISSON_LEVEL_H

#include <stdbool.h>

#include "stereo/poisson.h"

/* The arrays of count entries. */
status poisson_grid_allocate(poisson_grid *g);

/* A grid of half the size, with links but no weights yet, and the fine nodes' parents in it (fine->count). It has no
 * map of nodes, for where pieces meet a place has several. */
status poisson_grid_coarsen(const poisson_grid *fine, int *parent, poisson_grid *coarse);

/* The operator's diagonal at node i. */
static inline double poisson_diagonal(const poisson_grid *g, int i)
{
    double d = (double)g->pull[i] + (double)g->weight[0][i] + (double)g->weight[1][i];
    for (int k = 0; k < 2; k++)
        if (g->previous[k][i] >= 0) d += (double)g->weight[k][g->previous[k][i]];
    return d;
}

/* Σ weight × x over the neighbours of node i. */
static inline double poisson_around(const poisson_grid *g, int i, const double *x)
{
    double sum = 0;
    for (int k = 0; k < 2; k++) {
        int next = g->next[k][i], previous = g->previous[k][i];
        if (next >= 0) sum += (double)g->weight[k][i] * x[next];
        if (previous >= 0) sum += (double)g->weight[k][previous] * x[previous];
    }
    return sum;
}

/* Sparse Cholesky of a grid's operator; the ordering is found once, the numbers as often as weights change. */
typedef struct poisson_factor poisson_factor;
status poisson_factor_new(const poisson_grid *g, poisson_factor **out);
void poisson_factor_free(poisson_factor *f);
status poisson_factor_update(poisson_factor *f);
/* x = A⁻¹ b; may be the same array. */
status poisson_factor_solve(poisson_factor *f, const double *b, double *x);

#endif
