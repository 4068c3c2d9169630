/* SPDX-License-Identifier: MIT */
#include "stereo/integrate/poisson_factor.h"

#include <cholmod.h>
#include <stdlib.h>
#include <string.h>

#include "base/library.h"
#include "base/memory.h"

/* The library's functions, loaded when first needed. */
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

static const size_t for_blas = (size_t)512 << 20; /* bytes; a buffer is a quarter of it */

struct poisson_factor {
    int count;
    cholmod_common common;
    cholmod_sparse *matrix; /* lower half, one column per node */
    cholmod_factor *factor;
};

static status refuse(const poisson_factor *f)
{
    if (f->common.status == CHOLMOD_OUT_OF_MEMORY || f->common.status == CHOLMOD_TOO_LARGE)
        return fail(MERLIN_NO_MEMORY, "no memory to factorize %d unknowns", f->count);
    return fail(MERLIN_DEVICE_FAILED, "the factorization of %d unknowns failed (CHOLMOD status %d)", f->count,
                f->common.status);
}

/* Fills the matrix, one column per node with its links to later ones. The diagonal is summed from these entries, since
 * a link's weight may be rounded differently at its other end, and weak links must not make the whole indefinite. */
static void fill(poisson_factor *f, const poisson_graph *g)
{
    int *start = f->matrix->p, *row = f->matrix->i, at = 0;
    double *value = f->matrix->x;
    for (int i = 0; i < g->count; i++) {
        start[i] = at;
        row[at] = i;
        value[at++] = g->pull[i];
        for (int k = g->start[i]; k < g->start[i + 1]; k++) {
            if (g->neighbour[k] < i) continue;
            row[at] = g->neighbour[k];
            value[at++] = -(double)g->weight[k];
        }
    }
    start[g->count] = at;
    for (int i = 0; i < g->count; i++)
        for (int k = start[i] + 1; k < start[i + 1]; k++) {
            value[start[i]] -= value[k];
            value[start[row[k]]] -= value[k];
        }
}

/* Starts CHOLMOD without supernodes and METIS: supernodes use a BLAS, and OpenBLAS waits forever if it gets no memory;
 * METIS ends the program. Up to POISSON_DIRECT unknowns neither is faster. */
static void start(cholmod_common *common, int count)
{
    cholmod.start(common);
    common->print = 0;
    if (count > POISSON_DIRECT && memory_is_left(for_blas)) return;
    common->supernodal = CHOLMOD_SIMPLICIAL;
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_AMD;
}

status poisson_factor_new(const poisson_graph *g, poisson_factor **out)
{
    *out = NULL;
    status s = library_need(&libcholmod);
    if (s != OK) return s;
    poisson_factor *f = calloc(1, sizeof *f);
    if (!f) return fail(MERLIN_NO_MEMORY, "no memory to factorize %d unknowns", g->count);
    f->count = g->count;
    start(&f->common, f->count);
    size_t n = (size_t)g->count, links = (size_t)g->start[n] / 2;
    f->matrix = cholmod.allocate_sparse(n, n, n + links, false, true, -1, CHOLMOD_REAL, &f->common);
    if (f->matrix) {
        fill(f, g);
        f->factor = cholmod.analyze(f->matrix, &f->common);
    }
    bool complete = f->factor && cholmod.factorize(f->matrix, f->factor, &f->common) && f->common.status == CHOLMOD_OK;
    if (complete) {
        *out = f;
        return OK;
    }
    s = refuse(f);
    poisson_factor_free(f);
    return s;
}

void poisson_factor_free(poisson_factor *f)
{
    if (!f) return;
    cholmod.free_factor(&f->factor, &f->common);
    cholmod.free_sparse(&f->matrix, &f->common);
    cholmod.finish(&f->common);
    free(f);
}

status poisson_factor_solve(poisson_factor *f, const double *b, double *x)
{
    size_t n = (size_t)f->count;
    cholmod_dense right = {.nrow = n, .ncol = 1, .nzmax = n, .d = n, .x = (void *)b, .xtype = CHOLMOD_REAL};
    cholmod_dense *solution = cholmod.solve(CHOLMOD_A, f->factor, &right, &f->common);
    if (!solution) return refuse(f);
    memcpy(x, solution->x, n * sizeof *x);
    cholmod.free_dense(&solution, &f->common);
    return OK;
}
