/* SPDX-License-Identifier: MIT */
/* Sparse least squares over the pixels of a mask: known differences between neighbours, natural boundaries.
 *
 *     poisson_grid g;
 *     status s = poisson_grid_new(&mask, &g);            then fill weight, target and pull
 *     poisson_solver *solver;
 *     s = poisson_solver_new(&g, &solver);
 *     s = poisson_solve(solver, 1e-8, x);                again after changing weights or targets: x is the start
 *     poisson_solver_free(solver);
 *     poisson_grid_free(&g);
 *
 * minimizes  Σ weight (x_j − x_i − target)²  over pairs of neighbours  +  Σ pull (x_i − pulled_to)².
 *
 * Up to POISSON_DIRECT unknowns are solved by sparse Cholesky factorization (CHOLMOD); more by conjugate gradients,
 * preconditioned with a W-cycle over blocks of 2 × 2, 4 × 4 and so on, in which parts separated by jumps and slits stay
 * separate, with a factorization of the coarsest level. Memory is about 94 bytes per unknown (12 million: 1.1 GB). If
 * that does not converge, as on a narrow winding band, all unknowns are factorized, which needs about a kilobyte each.
 */
#ifndef MERLIN_STEREO_INTEGRATE_POISSON_H
#define MERLIN_STEREO_INTEGRATE_POISSON_H

#include "image/image.h"

enum { POISSON_DIRECT = 8000 };

/* Pixels and their pairs. Direction 0 is the pixel to the right, 1 the pixel below. */
typedef struct poisson_grid {
    int count, width, height;
    int *node;  /* width × height: index of the unknown, -1 outside */
    int *pixel; /* count: y × width + x */
    int *piece; /* count: index of the connected piece, from 0 to pieces - 1 */
    int pieces;
    int *next[2];     /* count: neighbour in that direction, -1 if none */
    int *previous[2]; /* count: neighbour in the opposite direction */
    float *weight[2]; /* count: weight of the pair with next */
    float *target[2]; /* count: target of x[next] − x */
    float *pull;      /* count: weight */
    float *pulled_to; /* count: value */
} poisson_grid;

/* Makes the grid. mask: 1 channel, above 0.5 on the object. Weights are 1, everything else 0. Fails if the mask is
 * empty. */
status poisson_grid_new(const img *mask, poisson_grid *g);
void poisson_grid_free(poisson_grid *g);

typedef struct poisson_solver poisson_solver;

/* Makes a solver, which borrows g. */
status poisson_solver_new(const poisson_grid *g, poisson_solver **out);
void poisson_solver_free(poisson_solver *s);
/* Solves. x: count values, the start and the result. tolerance: of the residual relative to the right-hand side, for
 * the iteration above POISSON_DIRECT. Every connected piece needs a pixel with pull > 0, or the factorization fails. */
status poisson_solve(poisson_solver *s, double tolerance, double *x);

#endif
