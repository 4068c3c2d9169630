#include "stereo/lapack.h"

#include <lapacke.h>
#include <pthread.h>

#include "base/library.h"

static struct {
    __typeof__(LAPACKE_dsyev) *dsyev;
    __typeof__(LAPACKE_dposv) *dposv;
} lapack;

static pthread_once_t once = PTHREAD_ONCE_INIT;
static bool loaded;

static void load(void)
{
    static const library_function wanted[] = {{"LAPACKE_dsyev", &lapack.dsyev}, {"LAPACKE_dposv", &lapack.dposv}};
    loaded = library_load(MERLIN_LAPACKE, wanted, sizeof wanted / sizeof *wanted);
}

static bool ready(void)
{
    pthread_once(&once, load);
    return loaded;
}

status lapack_begin(void)
{
    return ready() ? OK : fail(ERROR_DEVICE, "the library " MERLIN_LAPACKE " cannot be loaded: is it installed?");
}

bool lapack_eigen(double *m, int n, bool vectors, double *value)
{
    return ready() && lapack.dsyev(LAPACK_ROW_MAJOR, vectors ? 'V' : 'N', 'U', n, m, n, value) == 0;
}

bool lapack_solve_positive(double *m, int n, double *b)
{
    return ready() && lapack.dposv(LAPACK_ROW_MAJOR, 'L', n, 1, m, n, b, 1) == 0;
}
