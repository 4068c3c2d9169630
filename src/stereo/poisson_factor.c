#include <cholmod.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/poisson_level.h"

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
    poisson_factor *f = calloc(1, sizeof *f);
    *out = NULL;
    if (!f) return fail(ERROR_MEMORY, "no memory to factorize %d unknowns", g->count);
    f->grid = g;
    cholmod_start(&f->common);
    f->common.print = 0;
    size_t n = (size_t)g->count;
    f->matrix = cholmod_allocate_sparse(n, n, 3 * n, true, true, -1, CHOLMOD_REAL, &f->common);
    if (f->matrix) {
        fill(f);
        f->factor = cholmod_analyze(f->matrix, &f->common);
    }
    if (!f->factor) {
        status s = refuse(f);
        poisson_factor_free(f);
        return s;
    }
    *out = f;
    return OK;
}

void poisson_factor_free(poisson_factor *f)
{
    if (!f) return;
    cholmod_free_factor(&f->factor, &f->common);
    cholmod_free_sparse(&f->matrix, &f->common);
    cholmod_finish(&f->common);
    free(f);
}

status poisson_factor_update(poisson_factor *f)
{
    fill(f);
    if (!cholmod_factorize(f->matrix, f->factor, &f->common) || f->common.status != CHOLMOD_OK) return refuse(f);
    return OK;
}

status poisson_factor_solve(poisson_factor *f, const double *b, double *x)
{
    size_t n = (size_t)f->grid->count;
    cholmod_dense right = {.nrow = n, .ncol = 1, .nzmax = n, .d = n, .x = (void *)b, .xtype = CHOLMOD_REAL};
    cholmod_dense *solution = cholmod_solve(CHOLMOD_A, f->factor, &right, &f->common);
    if (!solution) return refuse(f);
    memcpy(x, solution->x, n * sizeof *x);
    cholmod_free_dense(&solution, &f->common);
    return OK;
}
