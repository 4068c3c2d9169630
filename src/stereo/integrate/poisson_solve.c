/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "stereo/integrate/poisson_level.h"

/* Largest number of steps of conjugate gradients, and how many more than with a new stack an old one may take. */
enum { MOST_STEPS = 100, MORE_STEPS = 3 };
/* Largest residual after the last step, in units of the tolerance. */
static const double MOST_ASTRAY = 100;

struct poisson_solver {
    const poisson_grid *grid;
    poisson_stack stack;
    /* right-hand side, which the conjugate gradients make their residual; the other arrays are needed only if the grid
     * is not factorized itself: the preconditioned residual, in whose place the operator is applied to the direction */
    double *r, *z, *p;
    double *x;           /* the caller's array */
    double length, turn; /* step length of the conjugate gradients, and their update of the direction */
    int steps_at_first;  /* number of steps with the stack when it was new; 0: it must be rebuilt */
    double sum[POISSON_STRIPS];
};

status poisson_solver_new(const poisson_grid *g, poisson_solver **out)
{
    poisson_solver *s = calloc(1, sizeof *s);
    *out = s;
    if (!s) return fail(MERLIN_NO_MEMORY, "no memory to integrate %d pixels", g->count);
    s->grid = g;
    double **arrays[] = {&s->r, &s->z, &s->p};
    size_t wanted = g->count <= POISSON_DIRECT ? 1 : 3, n = (size_t)g->count;
    for (size_t i = 0; i < wanted; i++)
        if (!(*arrays[i] = memory_new(n * sizeof(double)))) {
            poisson_solver_free(s);
            *out = NULL;
            return fail(MERLIN_NO_MEMORY, "no memory to integrate %zu pixels", n);
        }
    return OK;
}

void poisson_solver_free(poisson_solver *s)
{
    if (!s) return;
    poisson_stack_free(&s->stack);
    memory_free(s->r);
    memory_free(s->z);
    memory_free(s->p);
    free(s);
}

static void right_hand_side(const poisson_grid *g, double *b)
{
#pragma omp parallel for schedule(static)
    for (int i = 0; i < g->count; i++) {
        b[i] = (double)g->pull[i] * (double)g->pulled_to[i];
        for (int k = 0; k < 2; k++) {
            int before = g->previous[k][i];
            b[i] -= (double)g->weight[k][i] * (double)g->target[k][i];
            if (before >= 0) b[i] += (double)g->weight[k][before] * (double)g->target[k][before];
        }
    }
}

/* ---- conjugate gradients, by strips ---- */

typedef double strip_work(poisson_solver *s, int begin, int end);

typedef struct strip_job {
    poisson_solver *solver;
    strip_work *work;
} strip_job;

static void work_on(void *context, size_t i)
{
    strip_job *job = context;
    const int *strip = job->solver->stack.levels[0].strip;
    job->solver->sum[i] = job->work(job->solver, strip[i], strip[i + 1]);
}

/* Returns the sum over the strips. */
static double over_strips(poisson_solver *s, strip_work *work)
{
    double sum = 0;
    parallel_for(POISSON_STRIPS, work_on, &(strip_job){s, work});
    for (int i = 0; i < POISSON_STRIPS; i++)
        sum += s->sum[i];
    return sum;
}

static double square_of_r(poisson_solver *s, int begin, int end)
{
    double sum = 0;
    for (int i = begin; i < end; i++)
        sum += s->r[i] * s->r[i];
    return sum;
}

/* Computes r = b − A x, where r is b before; returns r·r. */
static double start(poisson_solver *s, int begin, int end)
{
    const poisson_level *finest = &s->stack.levels[0];
    double sum = 0;
    for (int i = begin; i < end; i++) {
        s->r[i] = poisson_residual(finest, i, s->r, s->x);
        s->p[i] = 0;
        sum += s->r[i] * s->r[i];
    }
    return sum;
}

static double residual_by_preconditioned(poisson_solver *s, int begin, int end)
{
    double sum = 0;
    for (int i = begin; i < end; i++)
        sum += s->r[i] * s->z[i];
    return sum;
}

static double turn(poisson_solver *s, int begin, int end)
{
    for (int i = begin; i < end; i++)
        s->p[i] = s->turn * s->p[i] + s->z[i];
    return 0;
}

/* Computes z = A p; returns p·z. */
static double apply(poisson_solver *s, int begin, int end)
{
    const poisson_level *finest = &s->stack.levels[0];
    double sum = 0;
    for (int i = begin; i < end; i++) {
        s->z[i] = poisson_diagonal(finest, i) * s->p[i] - poisson_around(finest, i, s->p);
        sum += s->p[i] * s->z[i];
    }
    return sum;
}

/* Updates x and r by z = A p; returns r·r. */
static double step(poisson_solver *s, int begin, int end)
{
    double sum = 0;
    for (int i = begin; i < end; i++) {
        s->x[i] += s->length * s->p[i];
        s->r[i] -= s->length * s->z[i];
        sum += s->r[i] * s->r[i];
    }
    return sum;
}

/* Iterates. *left: squared residual relative to the required one; *steps: number of steps made, at most `most`. */
static status conjugate_gradients(poisson_solver *s, double tolerance, int most, int *steps, double *left)
{
    right_hand_side(s->grid, s->r);
    double enough = tolerance * tolerance * over_strips(s, square_of_r), energy = 0, square = over_strips(s, start);
    if (!(enough > 0)) { /* b is zero */
        memset(s->x, 0, (size_t)s->grid->count * sizeof *s->x);
        square = 0;
    }
    for (*steps = 0; *steps < most && square > enough; ++*steps) {
        status result = poisson_stack_cycle(&s->stack, s->r, s->z);
        if (result != OK) return result;
        double before = energy;
        energy = over_strips(s, residual_by_preconditioned);
        s->turn = *steps ? energy / before : 0;
        over_strips(s, turn);
        double curvature = over_strips(s, apply);
        if (!(curvature > 0)) break;
        s->length = energy / curvature;
        square = over_strips(s, step);
    }
    *left = square / fmax(enough, 1e-300);
    return OK;
}

/* Factorizes the whole grid, whatever memory it takes. */
static status factorize(const poisson_solver *s)
{
    poisson_graph graph;
    poisson_factor *whole = NULL;
    right_hand_side(s->grid, s->r);
    status result = poisson_graph_of(s->grid, &graph);
    if (result == OK) result = poisson_factor_new(&graph, &whole);
    if (result == OK) result = poisson_factor_solve(whole, s->r, s->x);
    poisson_factor_free(whole);
    poisson_graph_free(&graph);
    return result;
}

static status build(poisson_solver *s)
{
    poisson_stack_free(&s->stack);
    return poisson_stack_new(s->grid, &s->stack);
}

/* Solves by iteration. A stack that was built for other weights is used until it takes too many steps. */
static status iterate(poisson_solver *s, double tolerance)
{
    int steps, most = s->steps_at_first + MORE_STEPS;
    double left = INFINITY;
    status result = OK;
    if (s->steps_at_first) result = conjugate_gradients(s, tolerance, most, &steps, &left);
    if (result != OK || left <= 1) return result;
    result = build(s);
    if (result == MERLIN_DEVICE_FAILED) return factorize(s);
    if (result == OK) result = conjugate_gradients(s, tolerance, MOST_STEPS, &s->steps_at_first, &left);
    return result == OK && left > MOST_ASTRAY * MOST_ASTRAY ? factorize(s) : result;
}

static status solve_directly(poisson_solver *s)
{
    right_hand_side(s->grid, s->r);
    status result = build(s);
    return result == OK ? poisson_factor_solve(s->stack.factor, s->r, s->x) : result;
}

status poisson_solve(poisson_solver *s, double tolerance, double *x)
{
    s->x = x;
    return s->grid->count <= POISSON_DIRECT ? solve_directly(s) : iterate(s, tolerance);
}
