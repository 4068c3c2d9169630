#include <math.h>
#include <string.h>

#include "stereo/integrate_steps.h"

enum { MOST_ROUNDS = 60 };
static const double SHARPNESS = 2;  /* k of the paper: how fast the worse side loses its say */
static const double SETTLED = 1e-4; /* relative change of the energy */
static const double TOLERANCE = 1e-6;
static const float LEAST_WEIGHT = 1e-5f; /* keeps the system definite where both sides of a pair are given up */

/* How far a neighbour is off the tangent plane at a pixel, in pixels, and the weight's other factor. */
typedef struct side {
    int neighbour;
    double target, off;
} side;

static side side_of(const integration_steps *s, int direction, int node, bool forward, vec3 n, const double *x)
{
    const poisson_grid *g = &s->grid;
    int other = forward ? g->next[direction][node] : g->previous[direction][node];
    if (other < 0) return (side){.neighbour = -1};
    double target = (double)steps_between(s, direction, forward ? other : node, n);
    double step = forward ? x[other] - x[node] : x[node] - x[other];
    double pixels = s->camera.perspective ? (double)s->camera.focal : 1;
    return (side){other, target, pixels * (double)steps_facing(s, node, n) * (step - target)};
}

static void add(poisson_grid *g, int direction, int from, double weight, double target)
{
    g->weight[direction][from] += (float)weight;
    g->target[direction][from] += (float)(weight * target);
}

/* The paper's eq. 14 and 15: σ(k (off the other side² − off this side²)). Returns the node's share of the energy. */
static double weigh_node(integration_steps *s, int direction, int node, const double *x)
{
    vec3 n = steps_normal(s, node);
    if (!(vec3_dot(n, n) > 0)) return 0;
    side after = side_of(s, direction, node, true, n, x), before = side_of(s, direction, node, false, n, x);
    double share = 1 / (1 + exp(-SHARPNESS * (before.off * before.off - after.off * after.off)));
    double facing = (double)steps_facing(s, node, n), scale = facing * facing;
    if (after.neighbour >= 0) add(&s->grid, direction, node, share * scale, after.target);
    if (before.neighbour >= 0) add(&s->grid, direction, before.neighbour, (1 - share) * scale, before.target);
    return share * after.off * after.off + (1 - share) * before.off * before.off;
}

/* Weights and targets from the surface x: both ends of a pair have their say. Returns the energy of x. */
static double reweigh(integration_steps *s, const double *x)
{
    poisson_grid *g = &s->grid;
    double energy = 0;
    for (int k = 0; k < 2; k++) {
        memset(g->weight[k], 0, (size_t)g->count * sizeof **g->weight);
        memset(g->target[k], 0, (size_t)g->count * sizeof **g->target);
        for (int i = 0; i < g->count; i++)
            energy += weigh_node(s, k, i, x);
        for (int i = 0; i < g->count; i++) {
            if (g->next[k][i] < 0) continue;
            if (g->weight[k][i] > 0) g->target[k][i] /= g->weight[k][i];
            g->weight[k][i] += LEAST_WEIGHT;
        }
    }
    return energy;
}

status integrate_edges(integration_steps *s, poisson_solver *solver, double *x)
{
    double before = INFINITY;
    for (int round = 0; round < MOST_ROUNDS; round++) {
        double energy = reweigh(s, x);
        if (fabs(before - energy) <= SETTLED * energy) break;
        before = energy;
        status result = poisson_solve(solver, TOLERANCE, x);
        if (result != OK) return result;
    }
    return OK;
}
