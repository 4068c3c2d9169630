/* SPDX-License-Identifier: MIT */
/* Levenberg-Marquardt steps for bundle.h. A cell's albedo always has its optimum for the other unknowns, so that it is
 * eliminated from each step (Schur's complement); corners and lights remain, one dense symmetric system. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "stereo/algebra/dense.h"
#include "stereo/uncalibrated/bundle.h"
#include "stereo/uncalibrated/bundle_priors.h"

/* Steps end at this gain or this damping, which is partly shared by the unknowns of a kind (shared_damping). Least
 * share of a value's weight that counts as curvature. Limits of lights' distances in radii of the object. */
static const double settled = 1e-6, most_damped = 1e8, shared_damping = 0.1;
static const float nearest = 1.1f, farthest = 60;
/* The same of distant ones, about BUNDLE_AFAR. */
static const float nearest_afar = 30, farthest_afar = 300;

/* A point of the surface; m is its normal's direction, not unit. */
typedef struct patch {
    vec3 at, m;
    float length; /* length of m */
} patch;

/* Computes a patch: the slopes s_x, s_y of log depth give (s_x, s_y, 1 + x s_x + y s_y), the cross product of the
 * surface's tangents. */
static patch patch_of(const bundle *b, const bundle_cell *c)
{
    const float *s = b->log_depth;
    float s0 = s[c->corner[0]], s1 = s[c->corner[1]], s2 = s[c->corner[2]], s3 = s[c->corner[3]];
    float x = (s1 + s3 - s0 - s2) / (2 * b->step), y = (s0 + s1 - s2 - s3) / (2 * b->step);
    float depth = expf(0.25f * (s0 + s1 + s2 + s3));
    patch p = {.at = vec3_make(depth * c->x, depth * c->y, -depth), .m = vec3_make(x, y, 1 + c->x * x + c->y * y)};
    p.length = vec3_length(p.m);
    return p;
}

static float shading(const patch *p, vec3 light)
{
    vec3 to = vec3_sub(light, p->at);
    float square = fmaxf(vec3_dot(to, to), 1e-12f);
    return vec3_dot(p->m, to) / (p->length * square * sqrtf(square));
}

vec3 bundle_normal(const bundle *b, int cell)
{
    const patch p = patch_of(b, &b->cell[cell]);
    return vec3_scale(p.m, 1 / p.length);
}

float bundle_shading(const bundle *b, int cell, vec3 light)
{
    patch p = patch_of(b, &b->cell[cell]);
    return shading(&p, light);
}

/* Returns the shading, which for a patch that faces away is zero if the value is dark, and keeps its slope if it is
 * bright, so that the patch turns back. */
static float seen_shading(float s, float value, float level)
{
    return s > 0 || value > 0.1f * level ? s : 0;
}

/* Geman and McClure's loss of a value, t / (1 + t), by its residual: half the slope divided by the residual, and half
 * the curvature limited to positive or nearly positive values, so that a step never ascends. */
typedef struct loss {
    float weight, curvature;
} loss;

static loss loss_of(float residual, float precision, float width)
{
    static const float flattest = 0.05f;
    float scale = precision / (width * width), t = residual * residual * scale, g = 1 / (1 + t);
    float weight = scale * g * g;
    return (loss){weight, weight * fmaxf((1 - 3 * t) * g, flattest)};
}

static void fit_albedos(bundle *b, float width)
{
    size_t lights = (size_t)b->lights;
    for (int i = 0; i < b->cells; i++) {
        bundle_cell *c = &b->cell[i];
        const float *v = b->value + (size_t)i * lights, *q = b->precision + (size_t)i * lights;
        patch p = patch_of(b, c);
        float product = 0, square = 0;
        for (size_t k = 0; k < lights; k++) {
            float s = seen_shading(b->strength[k] * shading(&p, b->position[k]), v[k], c->level);
            float w = c->albedo > 0 ? loss_of(v[k] - c->albedo * s, q[k], width).weight : q[k];
            product += w * s * v[k];
            square += w * s * s;
        }
        if (square > 0) c->albedo = fmaxf(product / square, 0);
    }
}

void bundle_fit_albedo(bundle *b)
{
    for (int i = 0; i < b->cells; i++)
        b->cell[i].albedo = 0;
    for (int k = 0; k < 3; k++)
        fit_albedos(b, 1);
}

/* Fits a light's strength to its picture. */
static float strength_of(const bundle *b, int light)
{
    float product = 0, square = 0;
    for (int i = 0; i < b->cells; i++) {
        const bundle_cell *c = &b->cell[i];
        const size_t at = (size_t)i * (size_t)b->lights + (size_t)light;
        const patch p = patch_of(b, c);
        const float s = fmaxf(c->albedo * shading(&p, b->position[light]), 0);
        product += b->precision[at] * s * b->value[at];
        square += b->precision[at] * s * s;
    }
    return square > 0 ? fmaxf(product / square, 1e-3f) : 1;
}

void bundle_fit_strengths(bundle *b)
{
    bundle_fit_albedo(b);
    for (int round = 0; round < 3; round++) {
        float mean = 0;
        for (int k = 0; k < b->lights; k++) {
            b->strength[k] = strength_of(b, k);
            mean += logf(b->strength[k]) / (float)b->lights;
        }
        for (int k = 0; k < b->lights; k++)
            b->strength[k] *= expf(-mean);
        bundle_fit_albedo(b);
    }
}

/* ---- values ---- */

static double cost_of(const bundle *b, float width)
{
    size_t lights = (size_t)b->lights;
    double cost = bundle_add_priors(b, NULL);
    for (int i = 0; i < b->cells; i++) {
        const bundle_cell *c = &b->cell[i];
        const float *v = b->value + (size_t)i * lights, *q = b->precision + (size_t)i * lights;
        patch p = patch_of(b, c);
        float sum = 0;
        for (size_t k = 0; k < lights; k++) {
            float s = b->strength[k] * shading(&p, b->position[k]);
            float r = v[k] - c->albedo * seen_shading(s, v[k], c->level);
            float t = r * r * q[k] / (width * width);
            sum += t / (1 + t);
        }
        cost += (double)sum;
    }
    return cost;
}

double bundle_light_cost(const bundle *b, int light, vec3 place, float width)
{
    double cost = 0;
    for (int i = 0; i < b->cells; i++) {
        const bundle_cell *c = &b->cell[i];
        size_t at = (size_t)i * (size_t)b->lights + (size_t)light;
        patch p = patch_of(b, c);
        float s = b->strength[light] * shading(&p, place);
        float r = b->value[at] - c->albedo * seen_shading(s, b->value[at], c->level);
        float t = r * r * b->precision[at] / (width * width);
        cost += (double)(t / (1 + t));
    }
    return cost;
}

/* Computes the derivatives of a light's position by its unknowns. */
static void find_turns(const bundle *b, bundle_equations *y)
{
    for (int k = 0; k < b->lights; k++) {
        vec3 from = vec3_sub(b->position[k], b->centre);
        vec3 other = fabsf(from.x) < 0.5f * vec3_length(from) ? vec3_make(1, 0, 0) : vec3_make(0, 1, 0);
        vec3 u = vec3_normalize(vec3_cross(from, other)), v = vec3_normalize(vec3_cross(from, u));
        y->turn[3 * k] = vec3_scale(u, vec3_length(from));
        y->turn[3 * k + 1] = vec3_scale(v, vec3_length(from));
        y->turn[3 * k + 2] = from;
    }
}

/* Computes derivatives of shading by the corners' log depth and by the light's position. */
static vec3 shading_slopes(const bundle *b, const bundle_cell *c, const patch *p, vec3 light, float by_corner[4])
{
    vec3 to = vec3_sub(light, p->at), m = vec3_scale(p->m, 1 / p->length);
    float square = fmaxf(vec3_dot(to, to), 1e-12f), cube = 1 / (square * sqrtf(square)), facing = vec3_dot(m, to);
    vec3 by_light = vec3_scale(vec3_fma(m, -3 * facing / square, to), cube);
    float along = -vec3_dot(by_light, p->at) / 4;
    /* derivative of m / |m|: the component perpendicular to it */
    vec3 across = vec3_scale(vec3_fma(to, -facing, m), cube / p->length);
    float x = (across.x + c->x * across.z) / (2 * b->step), y = (across.y + c->y * across.z) / (2 * b->step);
    by_corner[0] = along - x + y;
    by_corner[1] = along + x + y;
    by_corner[2] = along - x - y;
    by_corner[3] = along + x - y;
    return by_light;
}

/* Derivatives of one value by the cell's corners, the light's unknowns and the albedo. */
typedef struct slopes {
    float corner[4], light[4], albedo;
} slopes;

static void add_value(const bundle *b, bundle_equations *y, const bundle_cell *c, int light, const slopes *j, loss w,
                      float r)
{
    const size_t n = (size_t)y->size, at = bundle_light_row(b, light), unknowns = (size_t)bundle_light_unknowns(b);
    double *coupling = y->coupling + 4 + unknowns * (size_t)light;
    for (int i = 0; i < 4; i++) {
        double own = (double)(w.curvature * j->corner[i]);
        y->right[c->corner[i]] += (double)(w.weight * r * j->corner[i]);
        y->coupling[i] += own * (double)j->albedo;
        for (int k = 0; k < 4; k++)
            if (c->corner[k] <= c->corner[i])
                y->matrix[(size_t)c->corner[i] * n + (size_t)c->corner[k]] += own * (double)j->corner[k];
    }
    for (size_t i = 0; i < unknowns; i++) {
        double own = (double)(w.curvature * j->light[i]), *row = y->matrix + (at + i) * n;
        y->right[at + i] += (double)(w.weight * r * j->light[i]);
        coupling[i] += own * (double)j->albedo;
        for (int k = 0; k < 4; k++)
            row[c->corner[k]] += own * (double)j->corner[k];
        for (size_t k = 0; k <= i; k++)
            row[at + k] += own * (double)j->light[k];
    }
}

/* Eliminates the albedo. square, left: its own curvature and slope. */
static void eliminate_albedo(const bundle *b, bundle_equations *y, const bundle_cell *c, double square, double left)
{
    size_t n = (size_t)y->size;
    const double *q = y->coupling;
    for (int i = 0; i < 4; i++) {
        y->right[c->corner[i]] -= q[i] * left / square;
        for (int k = 0; k < 4; k++)
            if (c->corner[k] <= c->corner[i])
                y->matrix[(size_t)c->corner[i] * n + (size_t)c->corner[k]] -= q[i] * q[k] / square;
    }
    for (int i = 0; i < bundle_light_unknowns(b) * b->lights; i++) {
        double *row = y->matrix + (size_t)(b->corners + i) * n, own = q[4 + i] / square;
        if (own == 0) continue;
        y->right[b->corners + i] -= own * left;
        for (int k = 0; k < 4; k++)
            row[c->corner[k]] -= own * q[k];
        for (int k = 0; k <= i; k++)
            row[b->corners + k] -= own * q[4 + k];
    }
}

static void add_cell(const bundle *b, bundle_equations *y, int i, float width)
{
    size_t lights = (size_t)b->lights;
    const bundle_cell *c = &b->cell[i];
    const float *v = b->value + (size_t)i * lights, *q = b->precision + (size_t)i * lights;
    patch p = patch_of(b, c);
    double square = 0, left = 0;
    memset(y->coupling, 0, (4 + (size_t)bundle_light_unknowns(b) * lights) * sizeof *y->coupling);
    for (int k = 0; k < b->lights; k++) {
        const float power = c->albedo * b->strength[k], s = b->strength[k] * shading(&p, b->position[k]);
        if (q[k] <= 0 || seen_shading(s, v[k], c->level) != s) continue;
        float r = v[k] - c->albedo * s;
        loss w = loss_of(r, q[k], width);
        slopes j = {.albedo = s};
        vec3 by_light = shading_slopes(b, c, &p, b->position[k], j.corner);
        for (int t = 0; t < 4; t++)
            j.corner[t] *= power;
        for (int t = 0; t < 3; t++)
            j.light[t] = power * vec3_dot(by_light, y->turn[3 * k + t]);
        j.light[3] = c->albedo * s;
        add_value(b, y, c, k, &j, w, r);
        square += (double)(w.curvature * s * s);
        left += (double)(w.weight * r * s);
    }
    if (square > 0) eliminate_albedo(b, y, c, square, left);
}

/* ---- steps ---- */

static bool solve_step(bundle_equations *y, double damping)
{
    size_t n = (size_t)y->size;
    double mean[2] = {0};
    for (size_t i = 0; i < n; i++)
        mean[i >= y->corners] += y->matrix[i * n + i] / (double)(i < y->corners ? y->corners : n - y->corners);
    memcpy(y->damped, y->matrix, n * n * sizeof *y->damped);
    memcpy(y->step, y->right, n * sizeof *y->step);
    for (size_t i = 0; i < n; i++)
        y->damped[i * n + i] += damping * (y->matrix[i * n + i] + shared_damping * mean[i >= y->corners]) + 1e-9;
    return dense_solve_positive(y->damped, y->size, y->step);
}

static float within_limits(const bundle *b, float distance)
{
    const bool near = bundle_is_near(b);
    return fminf(fmaxf(distance, (near ? nearest : nearest_afar) * b->radius),
                 (near ? farthest : farthest_afar) * b->radius);
}

static void take_step(bundle *b, const bundle_equations *y)
{
    memcpy(y->old_depth, b->log_depth, (size_t)b->corners * sizeof *y->old_depth);
    memcpy(y->old_position, b->position, (size_t)b->lights * sizeof *y->old_position);
    memcpy(y->old_strength, b->strength, (size_t)b->lights * sizeof *y->old_strength);
    for (int i = 0; i < b->cells; i++)
        y->old_albedo[i] = b->cell[i].albedo;
    for (int i = 0; i < b->corners; i++)
        b->log_depth[i] += clamp((float)y->step[i], -0.3f, 0.3f);
    for (int k = 0; k < b->lights; k++) {
        const double *d = y->step + bundle_light_row(b, k);
        vec3 from = vec3_sub(b->position[k], b->centre), to = from;
        to = vec3_fma(to, clamp((float)d[0], -0.5f, 0.5f), y->turn[3 * k]);
        to = vec3_fma(to, clamp((float)d[1], -0.5f, 0.5f), y->turn[3 * k + 1]);
        const float distance = vec3_length(from) * expf(clamp((float)d[2], -0.5f, 0.5f));
        b->position[k] = vec3_fma(b->centre, within_limits(b, distance), vec3_normalize(to));
        if (b->kind == BUNDLE_NEAR_FREE) b->strength[k] *= expf(clamp((float)d[3], -0.5f, 0.5f));
    }
}

static void undo_step(bundle *b, const bundle_equations *y)
{
    memcpy(b->log_depth, y->old_depth, (size_t)b->corners * sizeof *y->old_depth);
    memcpy(b->position, y->old_position, (size_t)b->lights * sizeof *y->old_position);
    memcpy(b->strength, y->old_strength, (size_t)b->lights * sizeof *y->old_strength);
    for (int i = 0; i < b->cells; i++)
        b->cell[i].albedo = y->old_albedo[i];
}

/* Tries shorter and shorter steps; returns false if none gains. */
static bool descend(bundle *b, bundle_equations *y, float width, double *damping)
{
    double before = b->cost;
    for (; *damping < most_damped; *damping *= 5) {
        if (!solve_step(y, *damping)) continue;
        take_step(b, y);
        fit_albedos(b, width);
        b->cost = cost_of(b, width);
        if (b->cost < before) {
            *damping = fmax(*damping / 5, 1e-6);
            return true;
        }
        undo_step(b, y);
    }
    b->cost = before;
    return false;
}

static status system_new(const bundle *b, bundle_equations *y)
{
    size_t lights = (size_t)b->lights, n = bundle_light_row(b, b->lights);
    *y = (bundle_equations){
        .size = (int)n, .corners = (size_t)b->corners, .matrix = malloc((2 * n * n + 3 * n + 4) * sizeof *y->matrix)};
    y->turn = malloc(4 * lights * sizeof *y->turn);
    y->old_depth = malloc((size_t)(b->corners + b->cells + b->lights) * sizeof *y->old_depth);
    if (!y->matrix || !y->turn || !y->old_depth) return fail(MERLIN_NO_MEMORY, "no memory for %zu unknowns", n);
    y->damped = y->matrix + n * n;
    y->right = y->damped + n * n;
    y->step = y->right + n;
    y->coupling = y->step + n;
    y->old_position = y->turn + 3 * lights;
    y->old_albedo = y->old_depth + b->corners;
    y->old_strength = y->old_albedo + b->cells;
    return OK;
}

static void system_free(bundle_equations *y)
{
    free(y->matrix);
    free(y->turn);
    free(y->old_depth);
}

static void assemble(const bundle *b, bundle_equations *y, float width)
{
    size_t n = (size_t)y->size;
    memset(y->matrix, 0, n * n * sizeof *y->matrix);
    memset(y->right, 0, n * sizeof *y->right);
    find_turns(b, y);
    bundle_add_priors(b, y);
    for (int i = 0; i < b->cells; i++)
        add_cell(b, y, i, width);
}

status bundle_refine(bundle *b, float width, int steps)
{
    bundle_equations y;
    double damping = 1e-3;
    status s = system_new(b, &y);
    if (s == OK) {
        fit_albedos(b, width);
        b->cost = cost_of(b, width);
    }
    for (int k = 0; s == OK && k < steps; k++) {
        double before = b->cost;
        assemble(b, &y, width);
        if (!descend(b, &y, width, &damping) || b->cost > (1 - settled) * before) break;
    }
    system_free(&y);
    return s;
}
