/* SPDX-License-Identifier: MIT */
/* Dense linear algebra for photometric stereo, for matrices of three to some hundred rows.
 *
 *     double value[2 * N];
 *     if (!dense_eigen(gram, N, true, value)) s = fail(MERLIN_BAD_INPUT, "not numbers");
 *
 * Matrices are stored row by row. The functions need neither memory of their own nor a library: the available libraries
 * start threads, and wait forever if the system refuses them memory. */
#ifndef MERLIN_STEREO_ALGEBRA_DENSE_H
#define MERLIN_STEREO_ALGEBRA_DENSE_H

#include <stdbool.h>

/* Computes the eigenvalues, ascending, of the symmetric n × n matrix whose upper half is in m. With `vectors` the
 * eigenvectors replace it, a column each; otherwise its content is lost. value has room for 2 n numbers, of which the
 * first n are the result. Returns false if there are values that are not finite. */
bool dense_eigen(double *m, int n, bool vectors, double *value);

/* Solves m x = b and puts x into b; m: symmetric, its lower half given, overwritten. Returns false if m is not positive
 * definite. */
bool dense_solve_positive(double *m, int n, double *b);

#endif
