#include "stereo/lapack.h"

#include <lapacke.h>

#include "base/library.h"

static struct {
    __typeof__(LAPACKE_dsyev) *dsyev;
    __typeof__(LAPACKE_dposv) *dposv;
} lapack;

static const library_function wanted[] = {{"LAPACKE_dsyev", &lapack.dsyev}, {"LAPACKE_dposv", &lapack.dposv}};
static library liblapacke = {.file = MERLIN_LAPACKE, .functions = wanted, .count = sizeof wanted / sizeof *wanted};

status lapack_begin(void)
{
    return library_need(&liblapacke);
}

bool lapack_eigen(double *m, int n, bool vectors, double *value)
{
    return lapack_begin() == OK && lapack.dsyev(LAPACK_ROW_MAJOR, vectors ? 'V' : 'N', 'U', n, m, n, value) == 0;
}

bool lapack_solve_positive(double *m, int n, double *b)
{
    return lapack_begin() == OK && lapack.dposv(LAPACK_ROW_MAJOR, 'L', n, 1, m, n, b, 1) == 0;
}
