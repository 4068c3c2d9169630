#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/poisson_level.h"

enum { MOST_LEVELS = 16, MOST_STEPS = 100 };
/* Tolerances that may be left after the last step. */
static const double MOST_ASTRAY = 100;
/* A function that is constant over 2 × 2 blocks is stiffer than the smooth one it stands for: twice in two dimensions.
 * Coarse weights are divided by nearly that, as in Braess 1995, "Towards algebraic multigrid for elliptic problems of
 * second order". */
static const float STIFFNESS = 1.8f;

typedef struct level {
    const poisson_grid *grid;
    poisson_grid own;  /* what grid points to, but on the finest level */
    int *parent;       /* node of the next level */
    double *x, *b, *r; /* correction, right-hand side, residual; the finest level has r only */
} level;

struct poisson_solver {
    level levels[MOST_LEVELS];
    int depth;
    poisson_factor *factor;          /* of the last level */
    double *b, *r, *z, *p, *product; /* of the finest level; all but b only if it is not factorized itself */
};

/* ---- building ---- */

static status add_level(poisson_solver *s)
{
    level *fine = &s->levels[s->depth - 1], *coarse = &s->levels[s->depth];
    size_t n = (size_t)fine->grid->count;
    fine->parent = malloc(n * sizeof *fine->parent);
    fine->r = malloc(n * sizeof *fine->r);
    if (!fine->parent || !fine->r) return fail(ERROR_MEMORY, "no memory to integrate %zu pixels", n);
    coarse->grid = &coarse->own;
    s->depth++;
    status result = poisson_grid_coarsen(fine->grid, fine->parent, &coarse->own);
    if (result != OK) return result;
    size_t m = (size_t)coarse->grid->count;
    coarse->x = malloc(m * sizeof *coarse->x);
    coarse->b = malloc(m * sizeof *coarse->b);
    return coarse->x && coarse->b ? OK : fail(ERROR_MEMORY, "no memory to integrate %zu pixels", n);
}

static status allocate_vectors(poisson_solver *s, size_t n)
{
    s->b = malloc(n * sizeof *s->b);
    if (s->depth == 1) return s->b ? OK : fail(ERROR_MEMORY, "no memory to integrate %zu pixels", n);
    s->r = malloc(n * sizeof *s->r);
    s->z = malloc(n * sizeof *s->z);
    s->p = malloc(n * sizeof *s->p);
    s->product = malloc(n * sizeof *s->product);
    bool complete = s->b && s->r && s->z && s->p && s->product;
    return complete ? OK : fail(ERROR_MEMORY, "no memory to integrate %zu pixels", n);
}

status poisson_solver_new(const poisson_grid *g, poisson_solver **out)
{
    poisson_solver *s = calloc(1, sizeof *s);
    *out = NULL;
    if (!s) return fail(ERROR_MEMORY, "no memory to integrate %d pixels", g->count);
    s->levels[0].grid = g;
    s->depth = 1;
    status result = OK;
    while (result == OK && s->levels[s->depth - 1].grid->count > POISSON_DIRECT && s->depth < MOST_LEVELS)
        result = add_level(s);
    if (result == OK) result = poisson_factor_new(s->levels[s->depth - 1].grid, &s->factor);
    if (result == OK) result = allocate_vectors(s, (size_t)g->count);
    if (result != OK)
        poisson_solver_free(s);
    else
        *out = s;
    return result;
}

void poisson_solver_free(poisson_solver *s)
{
    if (!s) return;
    for (int i = 0; i < s->depth; i++) {
        level *l = &s->levels[i];
        poisson_grid_free(&l->own);
        free(l->parent);
        free(l->x);
        free(l->b);
        free(l->r);
    }
    poisson_factor_free(s->factor);
    free(s->b);
    free(s->r);
    free(s->z);
    free(s->p);
    free(s->product);
    free(s);
}

/* ---- numbers ---- */

/* Weights of pairs that lie across two blocks add up; pulls add up. */
static void project_weights(const poisson_grid *fine, const int *parent, poisson_grid *coarse)
{
    size_t m = (size_t)coarse->count;
    memset(coarse->pull, 0, m * sizeof *coarse->pull);
    for (int k = 0; k < 2; k++)
        memset(coarse->weight[k], 0, m * sizeof **coarse->weight);
    for (int i = 0; i < fine->count; i++) {
        coarse->pull[parent[i]] += fine->pull[i];
        for (int k = 0; k < 2; k++) {
            int next = fine->next[k][i];
            if (next >= 0 && parent[next] != parent[i]) coarse->weight[k][parent[i]] += fine->weight[k][i] / STIFFNESS;
        }
    }
}

static void right_hand_side(const poisson_grid *g, double *b)
{
    for (int i = 0; i < g->count; i++)
        b[i] = (double)g->pull[i] * (double)g->pulled_to[i];
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < g->count; i++) {
            double flow = (double)g->weight[k][i] * (double)g->target[k][i];
            b[i] -= flow;
            if (g->next[k][i] >= 0) b[g->next[k][i]] += flow;
        }
}

static void smooth_at(const poisson_grid *g, int i, const double *b, double *x)
{
    double d = poisson_diagonal(g, i);
    if (d > 0) x[i] = (b[i] + poisson_around(g, i, x)) / d;
}

static void residual(const poisson_grid *g, const double *b, const double *x, double *r)
{
#pragma omp parallel for schedule(static)
    for (int i = 0; i < g->count; i++)
        r[i] = b[i] - poisson_diagonal(g, i) * x[i] + poisson_around(g, i, x);
}

/* One W-cycle on level `at` toward A x = b: Gauss-Seidel forward, correction from the coarser level, Gauss-Seidel
 * backward, so that the whole is symmetric and fit to precondition conjugate gradients. */
static status cycle(poisson_solver *s, int at, const double *b, double *x)
{
    if (at == s->depth - 1) return poisson_factor_solve(s->factor, b, x);
    level *l = &s->levels[at], *below = &s->levels[at + 1];
    const poisson_grid *g = l->grid;
    for (int i = 0; i < g->count; i++)
        smooth_at(g, i, b, x);
    residual(g, b, x, l->r);
    size_t m = (size_t)below->grid->count;
    memset(below->b, 0, m * sizeof *below->b);
    memset(below->x, 0, m * sizeof *below->x);
    for (int i = 0; i < g->count; i++)
        below->b[l->parent[i]] += l->r[i];
    int times = at + 2 == s->depth ? 1 : 2;
    status result = OK;
    for (int i = 0; i < times && result == OK; i++)
        result = cycle(s, at + 1, below->b, below->x);
    for (int i = 0; i < g->count; i++)
        x[i] += below->x[l->parent[i]];
    for (int i = g->count - 1; i >= 0; i--)
        smooth_at(g, i, b, x);
    return result;
}

static double dot(const double *a, const double *b, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* y = a y + x */
static void scale_add(double *y, double a, const double *x, int n)
{
    for (int i = 0; i < n; i++)
        y[i] = a * y[i] + x[i];
}

static status precondition(poisson_solver *s, int n)
{
    memset(s->z, 0, (size_t)n * sizeof *s->z);
    return cycle(s, 0, s->r, s->z);
}

/* p·(A p), with A p left in product. */
static double apply(poisson_solver *s, const poisson_grid *g)
{
#pragma omp parallel for schedule(static)
    for (int i = 0; i < g->count; i++)
        s->product[i] = poisson_diagonal(g, i) * s->p[i] - poisson_around(g, i, s->p);
    return dot(s->p, s->product, g->count);
}

/* *astray: how many times the tolerance is left when no more steps are allowed, or below 1. */
static status conjugate_gradients(poisson_solver *s, double tolerance, double *x, double *astray)
{
    const poisson_grid *g = s->levels[0].grid;
    int n = g->count;
    residual(g, s->b, x, s->r);
    double enough = tolerance * tolerance * dot(s->b, s->b, n), energy = 0;
    memset(s->p, 0, (size_t)n * sizeof *s->p);
    for (int step = 0; step < MOST_STEPS && dot(s->r, s->r, n) > enough; step++) {
        status result = precondition(s, n);
        if (result != OK) return result;
        double before = energy;
        energy = dot(s->r, s->z, n);
        scale_add(s->p, step ? energy / before : 0, s->z, n);
        double curvature = apply(s, g);
        if (!(curvature > 0)) break;
        double length = energy / curvature;
        for (int i = 0; i < n; i++) {
            x[i] += length * s->p[i];
            s->r[i] -= length * s->product[i];
        }
    }
    *astray = sqrt(dot(s->r, s->r, n) / fmax(enough, 1e-300));
    return OK;
}

/* The whole of it, whatever memory that takes. */
static status factorize(const poisson_solver *s, double *x)
{
    poisson_factor *whole;
    status result = poisson_factor_new(s->levels[0].grid, &whole);
    if (result != OK) return result;
    result = poisson_factor_update(whole);
    if (result == OK) result = poisson_factor_solve(whole, s->b, x);
    poisson_factor_free(whole);
    return result;
}

/* Coarser grids join what narrow slits part, and then are no help. */
static status iterate(poisson_solver *s, double tolerance, double *x)
{
    double astray = 0;
    status result = conjugate_gradients(s, tolerance, x, &astray);
    return result == OK && astray > MOST_ASTRAY ? factorize(s, x) : result;
}

status poisson_solve(poisson_solver *s, double tolerance, double *x)
{
    for (int i = 0; i + 1 < s->depth; i++)
        project_weights(s->levels[i].grid, s->levels[i].parent, &s->levels[i + 1].own);
    status result = poisson_factor_update(s->factor);
    if (result != OK) return result;
    right_hand_side(s->levels[0].grid, s->b);
    return s->depth == 1 ? poisson_factor_solve(s->factor, s->b, x) : iterate(s, tolerance, x);
}
