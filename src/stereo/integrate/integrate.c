/* SPDX-License-Identifier: MIT */
#include "stereo/integrate/integrate.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "stereo/integrate/integrate_steps.h"

static const double TOLERANCE = 1e-7;
/* Least cosine to the line of sight: steeper slopes, above about 87 degrees, are limited to that. */
static const real GRAZING = (real)0.05;
/* Least weight, which keeps pairs connected of which nothing is known. */
static const float LEAST_WEIGHT = 1e-6f;

/* ---- steps between neighbours ---- */

/* Returns a node's normal; zero if there is none or it is not finite. */
static vec3 normal_at(const integration_steps *s, int node)
{
    const float *n = s->normal->data + 3 * (size_t)s->grid.pixel[node];
    vec3 v = vec3_of(n);
    return isfinite(v.x + v.y + v.z) ? vec3_normalize(v) : vec3_make(0, 0, 0);
}

static vec3 ray_of(const integration_steps *s, int node)
{
    const pinhole *c = &s->camera;
    if (!pinhole_is_near(c)) return vec3_make(0, 0, -1);
    int x = s->grid.pixel[node] % s->grid.width, y = s->grid.pixel[node] / s->grid.width;
    return vec3_make(((real)x + (real)0.5 - c->x) / c->focal, (c->y - (real)y - (real)0.5) / c->focal, -1);
}

/* Returns the cosine of the angle between m and the line of sight at a node, at least GRAZING, times the ray's length.
 */
static real facing_at(const integration_steps *s, int node, vec3 m)
{
    vec3 ray = ray_of(s, node);
    real length = vec3_length(ray), facing = -vec3_dot(m, ray), least = GRAZING * length * vec3_length(m);
    return facing > least ? facing : least;
}

/* Returns x[to] − x[from], for `to` the neighbour of `from` in the direction, along a chord perpendicular to m (not
 * zero). */
static real step_to(const integration_steps *s, int direction, int to, vec3 m)
{
    real across = direction == 0 ? m.x : -m.y, step = across / facing_at(s, to, m);
    if (!pinhole_is_near(&s->camera)) return step;
    step /= s->camera.focal;
    return log1p(step > (real)-0.9 ? step : (real)-0.9);
}

/* Sets steps and weights. The chord of a circular arc is perpendicular to the sum of the normals at its ends, so that
 * planes and spheres are exact. An error of the normal's angle changes the slope by 1/cos² of it, hence the weight
 * cos⁴. */
static void weigh_by_facing(integration_steps *s)
{
    poisson_grid *g = &s->grid;
    for (int k = 0; k < 2; k++) {
#pragma omp parallel for schedule(static)
        for (int i = 0; i < g->count; i++) {
            int to = g->next[k][i];
            if (to < 0) continue;
            vec3 m = vec3_normalize(vec3_add(normal_at(s, i), normal_at(s, to)));
            bool known = vec3_dot(m, m) > 0;
            real facing = known ? facing_at(s, to, m) : 0, square = facing * facing;
            g->target[k][i] = known ? (float)step_to(s, k, to, m) : 0;
            g->weight[k][i] = known ? (float)(square * square) : LEAST_WEIGHT;
        }
    }
}

/* ---- the constant of each piece ---- */

static bool has_prior(const pst_integration *o)
{
    return o->prior && o->prior_weight > 0;
}

/* Computes the unknown that corresponds to the prior; returns false if there is none at the pixel. */
static bool prior_at(const integration_steps *s, const pst_integration *o, int node, double *x)
{
    float depth = o->prior->data[s->grid.pixel[node]];
    if (!(depth > 0) || !isfinite(depth)) return false;
    *x = (double)(pinhole_is_near(&s->camera) ? logf(depth) : depth);
    return true;
}

/* Pulls every pixel toward its prior. A piece without a prior is held at its first pixel, which determines only its
 * constant. held: number of pieces. */
static void anchor(integration_steps *s, const pst_integration *o, int *held)
{
    poisson_grid *g = &s->grid;
    const int *piece = g->piece;
    for (int i = 0; i < g->count && has_prior(o); i++) {
        float trust = o->trust ? o->trust->data[g->pixel[i]] : 1;
        double x;
        if (!(trust > 0) || !prior_at(s, o, i, &x)) continue;
        g->pull[i] = o->prior_weight * trust;
        g->pulled_to[i] = (float)x;
        held[piece[i]] = 1;
    }
    for (int i = 0; i < g->count; i++)
        if (!held[piece[i]]) {
            g->pull[i] = 1;
            held[piece[i]] = -1;
        }
}

static void start_from_prior(const integration_steps *s, const pst_integration *o, double *x)
{
    for (int i = 0; i < s->grid.count; i++)
        prior_at(s, o, i, &x[i]);
}

/* Gives pieces without a prior the mean 0. */
static status center(const poisson_grid *g, const int *held, double *x)
{
    const int *piece = g->piece, pieces = g->pieces;
    double *sum = calloc((size_t)pieces, sizeof *sum), *count = calloc((size_t)pieces, sizeof *count);
    if (sum && count) {
        for (int i = 0; i < g->count; i++) {
            sum[piece[i]] += x[i];
            count[piece[i]]++;
        }
        for (int i = 0; i < g->count; i++)
            if (held[piece[i]] < 0) x[i] -= sum[piece[i]] / count[piece[i]];
    }
    bool complete = sum && count;
    free(sum);
    free(count);
    return complete ? OK : fail(MERLIN_NO_MEMORY, "no memory to integrate %d pixels", g->count);
}

/* ---- the whole ---- */

static void write_depth(const integration_steps *s, const int *held, const double *x, img *depth)
{
    const poisson_grid *g = &s->grid;
    double least = INFINITY, mean = s->camera.distance > 0 ? (double)s->camera.distance : 1;
    for (int i = 0; i < g->count; i++)
        if (held[g->piece[i]] < 0 && x[i] < least) least = x[i];
    for (int i = 0; i < g->count; i++) {
        bool free_constant = held[g->piece[i]] < 0;
        double d = pinhole_is_near(&s->camera) ? exp(x[i]) * (free_constant ? mean : 1)
                                               : x[i] + (free_constant ? 1 - least : 0);
        depth->data[g->pixel[i]] = (float)d;
    }
}

/* Solves for x, which has count entries. */
static status solve(integration_steps *s, const pst_integration *o, double *x, img *depth)
{
    int *held = calloc((size_t)s->grid.pieces, sizeof *held);
    if (!held) return fail(MERLIN_NO_MEMORY, "no memory to integrate %d pixels", s->grid.count);
    anchor(s, o, held);
    weigh_by_facing(s);
    poisson_solver *solver;
    status result = poisson_solver_new(&s->grid, &solver);
    bool stepped = o->preserve_edges && o->from_prior && has_prior(o);
    if (result == OK && stepped) start_from_prior(s, o, x);
    if (result == OK && !stepped) result = poisson_solve(solver, TOLERANCE, x);
    if (result == OK && o->preserve_edges) result = integrate_edges(s, solver, stepped, x);
    poisson_solver_free(solver);
    if (result == OK) result = center(&s->grid, held, x);
    if (result == OK) result = img_new(depth, s->normal->width, s->normal->height, 1);
    if (result == OK) write_depth(s, held, x, depth);
    free(held);
    return result;
}

static status check(const img *normal, const img *mask, const pinhole *camera, const pst_integration *o)
{
    if (normal->channels != 3) return fail(MERLIN_WRONG_USE, "normals have 3 channels, not %d", normal->channels);
    if (mask->width != normal->width || mask->height != normal->height)
        return fail(MERLIN_WRONG_USE, "the mask is %d × %d, the normals are %d × %d", mask->width, mask->height,
                    normal->width, normal->height);
    if (has_prior(o) && (o->prior->width != normal->width || o->prior->height != normal->height))
        return fail(MERLIN_WRONG_USE, "the depth to start from is %d × %d, the normals are %d × %d", o->prior->width,
                    o->prior->height, normal->width, normal->height);
    if (has_prior(o) && o->trust && (o->trust->width != normal->width || o->trust->height != normal->height))
        return fail(MERLIN_WRONG_USE, "the trust in depths is %d × %d, the normals are %d × %d", o->trust->width,
                    o->trust->height, normal->width, normal->height);
    if (!(camera->focal >= 0))
        return fail(MERLIN_WRONG_USE, "a camera's focal length is 0 (far away) or above, in pixels, not %g",
                    (double)camera->focal);
    return OK;
}

status pst_integrate(const img *normal, const img *mask, const pinhole *camera, const pst_integration *options,
                     img *depth)
{
    *depth = (img){0};
    status result = check(normal, mask, camera, options);
    if (result != OK) return result;
    integration_steps s = {.normal = normal, .camera = *camera, .watch = options->watch};
    result = poisson_grid_new(mask, &s.grid);
    if (result != OK) return result;
    double *x = memory_new((size_t)s.grid.count * sizeof *x);
    result =
        x ? solve(&s, options, x, depth) : fail(MERLIN_NO_MEMORY, "no memory to integrate %d pixels", s.grid.count);
    memory_free(x);
    poisson_grid_free(&s.grid);
    return result;
}
