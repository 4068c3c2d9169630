/* Dense linear algebra of photometric stereo by LAPACK, which is loaded when it is first needed (base/library.h).
 *
 *     status s = lapack_begin();
 *     if (s == OK && !lapack_eigen(gram, n, true, value)) s = fail(ERROR_INPUT, "not numbers");
 *
 * Matrices lie row by row; false where LAPACK finds no answer (values that are not numbers) or is not there. */
#ifndef MERLIN_STEREO_LAPACK_H
#define MERLIN_STEREO_LAPACK_H

#include <stdbool.h>

#include "base/status.h"

/* For a clear word before anything fails: ERROR_DEVICE if it is not installed. Any thread may call these. */
status lapack_begin(void);

/* Eigenvalues of the symmetric n × n matrix whose upper half is in m, ascending; with `vectors` the eigenvectors take
 * its place, a column each. */
bool lapack_eigen(double *m, int n, bool vectors, double *value);

/* x from m x = b, in b's place; m symmetric and positive, its lower half given, overwritten. */
bool lapack_solve_positive(double *m, int n, double *b);

#endif
