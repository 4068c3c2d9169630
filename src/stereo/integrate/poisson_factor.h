/* SPDX-License-Identifier: MIT */
/* Sparse Cholesky of a graph's operator, by CHOLMOD. Internal to the Poisson solver. */
#ifndef MERLIN_STEREO_INTEGRATE_POISSON_FACTOR_H
#define MERLIN_STEREO_INTEGRATE_POISSON_FACTOR_H

#include "stereo/integrate/poisson_graph.h"

typedef struct poisson_factor poisson_factor;
status poisson_factor_new(const poisson_graph *g, poisson_factor **out);
void poisson_factor_free(poisson_factor *f);
/* Computes x = A⁻¹ b; both may be the same array. */
status poisson_factor_solve(poisson_factor *f, const double *b, double *x);

#endif
