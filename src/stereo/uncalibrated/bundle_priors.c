/* SPDX-License-Identifier: MIT */
#include "stereo/uncalibrated/bundle_priors.h"

#include <math.h>

/* Weights of priors in units of an outlier: for the logarithm of a light's distance relative to the lights' mean; for a
 * bend and a twist of slope 1 between neighbouring cells, each times the number of lights; for the mean depth. */
static const double equal_distance = 1, bending = 0.003, twisting = 0.02, fixed_depth = 1e5;
/* Factor of the first for distant lights of equal strength, and for the logarithms of near lights' free strengths;
 * logarithm at which it is half given up for free ones. */
static const double equal_strength = 1000, free_strength = 0.1, uneven = 0.1;
/* The same for what is expected, of eight pictures: a slope of 1, each time per cell; a direction, times 1 minus the
 * cosine, twice; the logarithm of a distance. Powers of the number of pictures by which more of them reduce it, and
 * fewer raise it: what is expected errs the same way everywhere, and many pictures know better
 * (docs/notes/several_photographs.md). Least cosine that counts as curvature. */
static const double expected_slope = 0.3, expected_direction = 0.3, expected_distance = 0.1;
static const double eight = 8, many_fall = 4, few_rise = 1.7, least_curved = 0.05;

/* A quadratic form of corners: factor · (Σ share·log depth - target)². */
typedef struct form {
    const int *corner;
    const double *share;
    int count;
    double factor, target;
} form;
typedef void each_form(void *context, const form *f);

/* Returns the factor of what is expected, by the number of pictures. */
static double trust(const bundle *b)
{
    return pow(eight / b->lights, b->lights > eight ? many_fall : few_rise);
}

/* Lists the cells' expected slopes. */
static void list_expected(const bundle *b, each_form *tell, void *context)
{
    const bundle_expected *e = b->expected;
    const double unit = 1 / (2 * (double)b->step), trusted = expected_slope * trust(b);
    const double along[2][4] = {{-unit, unit, -unit, unit}, {unit, unit, -unit, -unit}};
    for (int i = 0; i < 2 * b->cells; i++) {
        const double weight = trusted * (double)e->weight[i / 2];
        if (weight > 0) tell(context, &(form){b->cell[i / 2].corner, along[i % 2], 4, weight, (double)e->slope[i]});
    }
}

static void list_forms(const bundle *b, each_form *tell, void *context)
{
    static const double bend[3] = {1, -2, 1}, twist[4] = {1, -1, -1, 1};
    double unit = b->lights / ((double)b->step * (double)b->step);
    for (int i = 0; i < b->cells; i++)
        tell(context, &(form){b->cell[i].corner, twist, 4, twisting * unit, 0});
    if (b->expected) list_expected(b, tell, context);
    int width = b->columns + 1;
    for (int k = 0; k < 2; k++) {
        int stride = k ? width : 1;
        for (int i = 0; i < width * (b->rows + 1); i++) {
            if (k ? i + 2 * width >= width * (b->rows + 1) : i % width + 2 >= width) continue;
            const int *at = b->corner_at;
            int corner[3] = {at[i], at[i + stride], at[i + 2 * stride]};
            if (corner[0] >= 0 && corner[1] >= 0 && corner[2] >= 0)
                tell(context, &(form){corner, bend, 3, bending * unit, 0});
        }
    }
}

typedef struct form_sum {
    const bundle *bundle;
    bundle_equations *equations; /* NULL: cost only */
    double cost;
} form_sum;

static void add_form(void *context, const form *of)
{
    form_sum *f = context;
    const int *corner = of->corner;
    double value = -of->target;
    for (int i = 0; i < of->count; i++)
        value += of->share[i] * (double)f->bundle->log_depth[corner[i]];
    f->cost += of->factor * value * value;
    if (!f->equations) return;
    size_t n = (size_t)f->equations->size;
    for (int i = 0; i < of->count; i++) {
        f->equations->right[corner[i]] -= of->factor * of->share[i] * value;
        for (int j = 0; j < of->count; j++)
            if (corner[j] <= corner[i])
                f->equations->matrix[(size_t)corner[i] * n + (size_t)corner[j]] +=
                    of->factor * of->share[i] * of->share[j];
    }
}

static float log_distance(const bundle *b, int light)
{
    return logf(vec3_length(vec3_sub(b->position[light], b->centre)));
}

/* Adds what is expected of the lights: the cosine between a direction and the expected one, and the logarithm of the
 * distances' ratio. */
static double add_expected_lights(const bundle *b, bundle_equations *y)
{
    const bundle_expected *e = b->expected;
    const float doubt = b->problem->expected->doubt_lights;
    const double trusted = trust(b) * (doubt > 0 ? (double)doubt : 1);
    double cost = 0;
    for (int k = 0; k < b->lights; k++) {
        const double weight = trusted * (double)e->sure[k] * b->cells;
        const double far = bundle_is_near(b) ? expected_distance * weight : 0;
        const vec3 from = vec3_sub(b->position[k], b->centre), wanted = vec3_sub(e->place[k], b->centre);
        const vec3 aim = vec3_normalize(wanted);
        const double cosine = (double)vec3_dot(aim, vec3_normalize(from));
        const double off = log((double)vec3_length(from) / (double)vec3_length(wanted));
        cost += 2 * expected_direction * weight * (1 - cosine) + far * off * off;
        if (!y) continue;
        const size_t n = (size_t)y->size, at = bundle_light_row(b, k);
        for (size_t i = 0; i < 2; i++) {
            y->right[at + i] += expected_direction * weight * (double)vec3_dot(aim, vec3_normalize(y->turn[3 * k + i]));
            y->matrix[(at + i) * n + at + i] += expected_direction * weight * fmax(cosine, least_curved);
        }
        y->right[at + 2] -= far * off;
        y->matrix[(at + 2) * n + at + 2] += far;
    }
    return cost;
}

/* Adds what a light's distance differs from the mean by, in logarithms. The difference is `off`, whose derivative by
 * another light's is -1 over their number; weight: that of its square, as far as it is not given up. */
static void add_distance(const bundle *b, bundle_equations *y, int light, double off, double weight)
{
    const double share = 1.0 / b->lights;
    for (int i = 0; i < b->lights; i++) {
        const double own = (i == light) - share;
        const size_t at = bundle_light_row(b, i) + 2;
        y->right[at] -= weight * off * own;
        for (int j = 0; j <= i; j++)
            y->matrix[at * (size_t)y->size + bundle_light_row(b, j) + 2] += weight * own * ((j == light) - share);
    }
}

static double add_equal_distances(const bundle *b, bundle_equations *y)
{
    const double prior = equal_distance * b->cells * (b->kind == BUNDLE_DISTANT_EQUAL ? equal_strength : 1);
    const bool strict = b->kind != BUNDLE_DISTANT_FREE;
    double mean = 0, cost = 0;
    for (int k = 0; k < b->lights; k++)
        mean += (double)log_distance(b, k) / b->lights;
    for (int k = 0; k < b->lights; k++) {
        const double off = (double)log_distance(b, k) - mean, ratio = off * off / (uneven * uneven);
        cost += prior * (strict ? off * off : uneven * uneven * log1p(ratio));
        if (y) add_distance(b, y, k, off, prior / (strict ? 1 : 1 + ratio));
    }
    return cost;
}

/* Adds what near lights' free strengths differ from 1 by, in logarithms. */
static double add_equal_strengths(const bundle *b, bundle_equations *y)
{
    const double prior = equal_distance * b->cells * free_strength;
    double cost = 0;
    for (int k = 0; k < b->lights; k++) {
        const double off = log((double)b->strength[k]), ratio = off * off / (uneven * uneven);
        cost += prior * uneven * uneven * log1p(ratio);
        if (!y) continue;
        const size_t at = bundle_light_row(b, k) + 3;
        const double weight = prior / (1 + ratio);
        y->right[at] -= weight * off;
        y->matrix[at * (size_t)y->size + at] += weight;
    }
    return cost;
}

double bundle_add_priors(const bundle *b, bundle_equations *y)
{
    form_sum f = {b, y, 0};
    list_forms(b, add_form, &f);
    size_t n = y ? (size_t)y->size : 0;
    double sum = 0;
    for (int i = 0; i < b->corners; i++)
        sum += (double)b->log_depth[i] / b->corners;
    f.cost += fixed_depth * sum * sum;
    double share = fixed_depth / ((double)b->corners * b->corners);
    for (size_t i = 0; y && i < (size_t)b->corners; i++) {
        y->right[i] -= fixed_depth * sum / b->corners;
        for (size_t j = 0; j <= i; j++)
            y->matrix[i * n + j] += share;
    }
    f.cost += add_equal_distances(b, y);
    if (b->kind == BUNDLE_NEAR_FREE) f.cost += add_equal_strengths(b, y);
    if (b->expected) f.cost += add_expected_lights(b, y);
    return f.cost;
}
