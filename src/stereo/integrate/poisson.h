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
 * Up to POISSON_DIRECT unknowns by sparse Cholesky factorization (CHOLMOD); above it by
 * conjugate gradients preconditioned with a W-cycle over blocks of 2 × 2, 4 × 4 and on, in which what jumps and slits
 * part stays apart, the coarsest level factorized. Memory is about 110 bytes an unknown (12 million: 1.3 GB). Where
 * that does not converge, as on a band that winds to and fro, all unknowns are factorized, in about a kilobyte each. */
#ifndef MERLIN_STEREO_INTEGRATE_POISSON_H
#define MERLIN_STEREO_INTEGRATE_POISSON_H

#include "image/image.h"

enum { POISSON_DIRECT = 8000 };

/* Direction 0 is the pixel to the right, 1 the pixel below. */
typedef struct poisson_grid {
    int count, width, height;
    int *node;  /* width × height: number of the unknown, -1 outside */
    int *pixel; /* count: y × width + x */
    int *piece; /* count: number of the connected piece, from 0 up to pieces - 1 */
    int pieces;
    int *next[2];     /* count: neighbour in that direction, -1 if none */
    int *previous[2]; /* count: neighbour against it */
    float *weight[2]; /* count: of the pair with next */
    float *target[2]; /* count: x[next] − x */
    float *pull;      /* count */
    float *pulled_to; /* count */
} poisson_grid;

/* mask: 1 channel, above 0.5 on the object. Weights are 1, all else 0. Refuses an empty mask. */
status poisson_grid_new(const img *mask, poisson_grid *g);
void poisson_grid_free(poisson_grid *g);

typedef struct poisson_solver poisson_solver;

/* Borrows g. */
status poisson_solver_new(const poisson_grid *g, poisson_solver **out);
void poisson_solver_free(poisson_solver *s);
/* x: count values, the start and the result. tolerance: of the residual relative to the right-hand side, for the
 * iteration above POISSON_DIRECT. Every connected piece needs a pixel with pull > 0, else the factorization is
 * refused. */
status poisson_solve(poisson_solver *s, double tolerance, double *x);

#endif
