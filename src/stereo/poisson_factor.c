#include <cholmod.h>
#include <stdlib.h>
#include <string.h>

#include "base/library.h"
#include "stereo/poisson_level.h"

/* Loaded when it is first needed. */
static struct {
    __typeof__(cholmod_start) *start;
    __typeof__(cholmod_finish) *finish;
    __typeof__(cholmod_allocate_sparse) *allocate_sparse;
    __typeof__(cholmod_free_sparse) *free_sparse;
    __typeof__(cholmod_analyze) *analyze;
    __typeof__(cholmod_factorize) *factorize;
    __typeof__(cholmod_free_factor) *free_factor;
    __typeof__(cholmod_solve) *solve;
    __typeof__(cholmod_free_dense) *free_dense;
} cholmod;

static const library_function wanted[] = {
    {"cholmod_start", &cholmod.start},
    {"cholmod_finish", &cholmod.finish},
    {"cholmod_allocate_sparse", &cholmod.allocate_sparse},
    {"cholmod_free_sparse", &cholmod.free_sparse},
    {"cholmod_analyze", &cholmod.analyze},
    {"cholmod_factorize", &cholmod.factorize},
    {"cholmod_free_factor", &cholmod.free_factor},
    {"cholmod_solve", &cholmod.solve},
    {"cholmod_free_dense", &cholmod.free_dense},
};
static library libcholmod = {.file = MERLIN_CHOLMOD, .functions = wanted, .count = sizeof wanted / sizeof *wanted};

struct poisson_factor {
    const poisson_grid *grid;
    cholmod_common common;
    cholmod_sparse *matrix; /* lower half, a column a node */
    cholmod_factor *factor;
};

static status refuse(const poisson_factor *f)
{
    if (f->common.status == CHOLMOD_OUT_OF_MEMORY || f->common.status == CHOLMOD_TOO_LARGE)
        return fail(ERROR_MEMORY, "no memory to factorize %d unknowns", f->grid->count);
    return fail(ERROR_DEVICE, "the factorization of %d unknowns failed (CHOLMOD status %d)", f->grid->count,
                f->common.status);
}

/* Fills the numbers, and the first time around the places they stand at. Rows within a column ascend: a node's right
 * neighbour has a smaller number than the one below. */
static void fill(poisson_factor *f)
{
    const poisson_grid *g = f->grid;
    int *start = f->matrix->p, *row = f->matrix->i, at = 0;
    double *value = f->matrix->x;
    for (int i = 0; i < g->count; i++) {
        start[i] = at;
        row[at] = i;
        value[at++] = poisson_diagonal(g, i);
        for (int k = 0; k < 2; k++) {
            if (g->next[k][i] < 0) continue;
            row[at] = g->next[k][i];
            value[at++] = -(double)g->weight[k][i];
        }
    }
    start[g->count] = at;
}

status poisson_factor_new(const poisson_grid *g, poisson_factor **out)
{
    *out = NULL;
    status s = library_need(&libcholmod);
    if (s != OK) return s;
    poisson_factor *f = calloc(1, sizeof *f);
    if (!f) return fail(ERROR_MEMORY, "no memory to factorize %d unknowns", g->count);
    f->grid = g;
    cholmod.start(&f->common);
    f->common.print = 0;
    size_t n = (size_t)g->count;
    f->matrix = cholmod.allocate_sparse(n, n, 3 * n, true, true, -1, CHOLMOD_REAL, &f->common);
    if (f->matrix) {
        fill(f);
        f->factor = cholmod.analyze(f->matrix, &f->common);
    }
    if (!f->factor) {
        s = refuse(f);
        poisson_factor_free(f);
        return s;
    }
    *out = f;
    return OK;
}

void poisson_factor_free(poisson_factor *f)
{
    if (!f) return;
    cholmod.free_factor(&f->factor, &f->common);
    cholmod.free_sparse(&f->matrix, &f->common);
    cholmod.finish(&f->common);
    free(f);
}

status poisson_factor_update(poisson_factor *f)
{
    fill(f);
    if (!cholmod.factorize(f->matrix, f->factor, &f->common) || f->common.status != CHOLMOD_OK) return refuse(f);
    return OK;
}

status poisson_factor_solve(poisson_factor *f, const double *b, double *x)
{
    size_t n = (size_t)f->grid->count;
    cholmod_dense right = {.nrow = n, .ncol = 1, .nzmax = n, .d = n, .x = (void *)b, .xtype = CHOLMOD_REAL};
    cholmod_dense *solution = cholmod.solve(CHOLMOD_A, f->factor, &right, &f->common);
    if (!solution) return refuse(f);
    memcpy(x, solution->x, n * sizeof *x);
    cholmod.free_dense(&solution, &f->common);
    return OK;
}
