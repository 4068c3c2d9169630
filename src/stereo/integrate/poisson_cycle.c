/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "base/parallel.h"
#include "stereo/integrate/poisson_level.h"

/* Largest useful size of a level, as a share of the previous one. */
static const double LEAST_GAIN = 0.8;

static bool more_levels(const poisson_stack *s)
{
    int last = s->levels[s->depth - 1].count;
    if (last <= POISSON_DIRECT || s->depth == POISSON_LEVELS) return false;
    return s->depth == 1 || last < LEAST_GAIN * s->levels[s->depth - 2].count;
}

status poisson_stack_new(const poisson_grid *g, poisson_stack *s)
{
    *s = (poisson_stack){.depth = 1};
    s->levels[0] = (poisson_level){.grid = g, .count = g->count};
    status result = poisson_level_prepare(&s->levels[0]);
    while (result == OK && more_levels(s)) {
        result = poisson_level_coarsen(&s->levels[s->depth - 1], &s->levels[s->depth]);
        s->depth++;
    }
    if (result == OK && s->depth == 1) result = poisson_graph_of(g, &s->levels[0].graph);
    return result == OK ? poisson_factor_new(&s->levels[s->depth - 1].graph, &s->factor) : result;
}

void poisson_stack_free(poisson_stack *s)
{
    for (int i = 0; i < s->depth; i++)
        poisson_level_free(&s->levels[i]);
    poisson_factor_free(s->factor);
}

/* Work between one level and the next. */
typedef struct passage {
    const poisson_level *fine, *coarse;
    const double *b;
    double *x;
    bool odd; /* which colour of the checkerboard */
} passage;

/* Makes a Gauss-Seidel step at a node of one colour of the checkerboard, whose neighbours have the other or are in its
 * own block. */
static void smooth_at(const passage *p, int i)
{
    const poisson_level *l = p->fine;
    if (l->odd[i] != p->odd) return;
    double d = poisson_diagonal(l, i);
    if (d > 0) p->x[i] = (p->b[i] + poisson_around(l, i, p->x)) / d;
}

static void smooth_strip(void *context, size_t strip)
{
    const passage *p = context;
    for (int i = p->fine->strip[strip]; i < p->fine->strip[strip + 1]; i++)
        smooth_at(p, i);
}

/* Smooths in reverse order, so that the whole cycle is symmetric. */
static void smooth_strip_back(void *context, size_t strip)
{
    const passage *p = context;
    for (int i = p->fine->strip[strip + 1] - 1; i >= p->fine->strip[strip]; i--)
        smooth_at(p, i);
}

/* Restricts the residual; it is zero at the pixels that were smoothed last. */
static void restrict_strip(void *context, size_t strip)
{
    const passage *p = context;
    const poisson_level *l = p->fine;
    for (int i = l->strip[strip]; i < l->strip[strip + 1]; i++)
        if (!l->grid || !l->odd[i]) p->coarse->b[l->parent[i]] += poisson_residual(l, i, p->b, p->x);
}

/* Adds the correction; pixels that are smoothed first do not need it. */
static void correct_strip(void *context, size_t strip)
{
    const passage *p = context;
    const poisson_level *l = p->fine;
    for (int i = l->strip[strip]; i < l->strip[strip + 1]; i++)
        if (!l->grid || !l->odd[i]) p->x[i] += p->coarse->x[l->parent[i]];
}

static void smooth(passage *p, bool odd, void (*strip)(void *context, size_t i))
{
    p->odd = odd;
    parallel_for(POISSON_STRIPS, strip, p);
}

/* Runs a cycle: even and odd nodes, correction from the coarser level, odd and even nodes. */
static status cycle(poisson_stack *s, int at, const double *b, double *x)
{
    if (at == s->depth - 1) return poisson_factor_solve(s->factor, b, x);
    passage p = {.fine = &s->levels[at], .coarse = &s->levels[at + 1], .b = b, .x = x};
    size_t bytes = (size_t)p.coarse->count * sizeof *p.coarse->b;
    smooth(&p, false, smooth_strip);
    smooth(&p, true, smooth_strip);
    memset(p.coarse->b, 0, bytes);
    memset(p.coarse->x, 0, bytes);
    parallel_for(POISSON_STRIPS, restrict_strip, &p);
    int times = at + 2 == s->depth ? 1 : 2;
    status result = OK;
    for (int i = 0; i < times && result == OK; i++)
        result = cycle(s, at + 1, p.coarse->b, p.coarse->x);
    parallel_for(POISSON_STRIPS, correct_strip, &p);
    smooth(&p, true, smooth_strip_back);
    smooth(&p, false, smooth_strip_back);
    return result;
}

status poisson_stack_cycle(poisson_stack *s, const double *b, double *x)
{
    memset(x, 0, (size_t)s->levels[0].count * sizeof *x);
    return cycle(s, 0, b, x);
}
