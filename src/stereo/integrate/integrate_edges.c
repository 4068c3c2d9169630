/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/integrate/integrate_steps.h"

/* Range and growth of the paper's sharpness k, per square pixel of misfit. The paper uses 2 from the first round on,
 * where the least-squares surface has spread every jump over its surroundings: no pair has a large misfit, both sides
 * of a pixel look alike, and the weights do not change. A slowly growing sharpness lets the first faint differences
 * accumulate along the jump before any pair is cut for good (graduated non-convexity, Blake & Zisserman 1987). It ends
 * where a tenth of a pixel still counts as noise, as real normals are not more consistent than that. */
static const double FIRST_SHARPNESS = 2, LAST_SHARPNESS = 100, GROWTH = 1.08;
/* First sharpness and its growth, which can be faster, if x has its jumps from the start. */
static const double STEPPED_SHARPNESS = 10, STEPPED_GROWTH = 3;
static const double TOLERANCE = 1e-6;
static const float LEAST_WEIGHT = 1e-6f; /* keeps the system definite where both sides of a pair are cut */

/* Values of the pairs of nodes with their next neighbours, by direction. */
typedef struct pairs {
    float *base[2];   /* weight by least squares */
    float *misfit[2]; /* squared misfit in pixels along the normal */
    float *along[2];  /* misfit averaged with the adjacent pairs, as a jump is a line, not a point */
} pairs;

static void pairs_free(pairs *p)
{
    for (int k = 0; k < 2; k++) {
        free(p->base[k]);
        free(p->misfit[k]);
        free(p->along[k]);
    }
}

static status pairs_new(const poisson_grid *g, pairs *p)
{
    size_t bytes = (size_t)g->count * sizeof(float);
    bool complete = true;
    for (int k = 0; k < 2; k++) {
        p->base[k] = malloc(bytes);
        p->misfit[k] = malloc(bytes);
        p->along[k] = malloc(bytes);
        complete &= p->base[k] && p->misfit[k] && p->along[k];
        if (complete) memcpy(p->base[k], g->weight[k], bytes);
    }
    return complete ? OK : fail(MERLIN_NO_MEMORY, "no memory to integrate %d pixels", g->count);
}

static void find_misfits(const integration_steps *s, const double *x, int k, pairs *p)
{
    const poisson_grid *g = &s->grid;
    double pixels = pinhole_is_near(&s->camera) ? (double)s->camera.focal : 1;
#pragma omp parallel for schedule(static)
    for (int i = 0; i < g->count; i++) {
        int to = g->next[k][i];
        double off = to < 0 ? 0 : pixels * (x[to] - x[i] - (double)g->target[k][i]);
        p->misfit[k][i] = to < 0 ? 0 : p->base[k][i] * (float)(off * off);
    }
#pragma omp parallel for schedule(static)
    for (int i = 0; i < g->count; i++) {
        const int beside[2] = {g->next[1 - k][i], g->previous[1 - k][i]};
        float sum = 2 * p->misfit[k][i], count = 2;
        for (int j = 0; j < 2; j++) {
            if (beside[j] < 0 || g->next[k][beside[j]] < 0) continue;
            sum += p->misfit[k][beside[j]];
            count++;
        }
        p->along[k][i] = sum / count;
    }
}

/* Returns the weight of node i for its next neighbour relative to its previous one (the paper's eq. 14). */
static float share_of_next(const poisson_grid *g, const pairs *p, int k, int i, double sharpness)
{
    int before = g->previous[k][i];
    if (before < 0 || g->next[k][i] < 0) return 0.5f;
    return (float)(1 / (1 + exp(sharpness * (double)(p->along[k][i] - p->along[k][before]))));
}

/* Sets the weights of pairs from those of both ends. */
static void reweigh(const poisson_grid *g, const pairs *p, int k, double sharpness)
{
#pragma omp parallel for schedule(static)
    for (int i = 0; i < g->count; i++) {
        int to = g->next[k][i];
        if (to < 0) continue;
        float share = share_of_next(g, p, k, i, sharpness) + 1 - share_of_next(g, p, k, to, sharpness);
        g->weight[k][i] = share * p->base[k][i] + LEAST_WEIGHT;
    }
}

status integrate_edges(integration_steps *s, poisson_solver *solver, bool stepped, double *x)
{
    pairs p = {0};
    status result = pairs_new(&s->grid, &p);
    double first = stepped ? STEPPED_SHARPNESS : FIRST_SHARPNESS, growth = stepped ? STEPPED_GROWTH : GROWTH;
    double rounds = ceil(log(LAST_SHARPNESS / first) / log(growth)), round = 0;
    for (double sharpness = first; result == OK && sharpness < LAST_SHARPNESS; sharpness *= growth) {
        watch_tell(s->watch, "integrating", fmin(round++ / rounds, 1));
        if (watch_stops(s->watch)) result = fail(MERLIN_STOPPED, "stopped");
        for (int k = 0; k < 2; k++) {
            find_misfits(s, x, k, &p);
            reweigh(&s->grid, &p, k, sharpness);
        }
        if (result == OK) result = poisson_solve(solver, TOLERANCE, x);
    }
    pairs_free(&p);
    return result;
}
