/* SPDX-License-Identifier: MIT */
/* Dense linear algebra of photometric stereo, for matrices of three to some hundred rows.
 *
 *     double value[2 * N];
 *     if (!dense_eigen(gram, N, true, value)) s = fail(MERLIN_BAD_INPUT, "not numbers");
 *
 * Matrices lie row by row. Nothing here needs memory of its own, or a library: those that there are start threads, and
 * wait for ever where the system refuses them memory. */
#ifndef MERLIN_STEREO_ALGEBRA_DENSE_H
#define MERLIN_STEREO_ALGEBRA_DENSE_H

#include <stdbool.h>

/* Eigenvalues of the symmetric n × n matrix whose upper half is in m, ascending; with `vectors` the eigenvectors take
 * its place, a column each, else nothing that is of use. value has room for 2 n numbers, of which the first n are the
 * answer. False if there are values that are not numbers. */
bool dense_eigen(double *m, int n, bool vectors, double *value);

/* x from m x = b, in b's place; m symmetric, its lower half given, overwritten. False if m is not positive. */
bool dense_solve_positive(double *m, int n, double *b);

#endif
