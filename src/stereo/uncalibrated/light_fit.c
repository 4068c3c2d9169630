/* SPDX-License-Identifier: MIT */
#include "stereo/uncalibrated/light_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "stereo/algebra/dense.h"
#include "stereo/uncalibrated/light_terms.h"

/* Number of pixels, of steps, and of tries with more damping. */
enum { SAMPLE = 5000, STEPS = 40, TRIES = 8, HEIGHTS = 3 };
/* Heights of the starting surfaces relative to the one most similar to the expected surface. */
static const double heights[HEIGHTS] = {1, 1.7, 0.6};
/* light_terms.uneven of lights that may be equally strong, and of others. */
static const double even = 0.02, given_up = 0.2;
/* Upper quartile of the logarithms of strengths from which on they are not equal. Measured: 0.001 to 0.03 where they
 * were, 0.45 to 0.7 of pictures that were exposed up to 2.5 times as much as others, or 0.36 and more where the fit
 * failed. */
static const double unequal = 0.15;

/* ---- the pixels ---- */

static exact3 unit_at(const pst_pseudo *f, int32_t slot)
{
    return exact3_normalize(exact3_of(f->b[slot]));
}

static exact3 slope(exact3 from, exact3 to)
{
    return exact3_scale(exact3_sub(to, from), 0.5);
}

static bool point_at(const pst_pseudo *f, size_t at, light_point *out)
{
    const int width = f->problem->capture->width, height = f->problem->capture->height;
    const int x = (int)(at % (size_t)width), y = (int)(at / (size_t)width);
    const int32_t *slot = f->slot + at;
    const pst_expected *expected = f->problem->expected;
    if (x < 1 || y < 1 || x + 1 >= width || y + 1 >= height) return false;
    if (slot[-1] < 0 || slot[1] < 0 || slot[-width] < 0 || slot[width] < 0) return false;
    out->b = unit_at(f, slot[0]);
    out->right = slope(unit_at(f, slot[-1]), unit_at(f, slot[1]));
    out->up = slope(unit_at(f, slot[width]), unit_at(f, slot[-width]));
    out->like[LIGHT_OUTLINE] = exact3_of(vec3_of(f->inflated->data + 3 * at));
    out->like[LIGHT_EXPECTED] = expected ? exact3_of(vec3_of(expected->normal->data + 3 * at)) : (exact3){0, 0, 0};
    return isfinite(exact3_dot(out->b, out->b) + exact3_dot(out->right, out->up));
}

static status take_points(const pst_pseudo *f, light_terms *out)
{
    const pst_problem *p = f->problem;
    const size_t step = p->pixel_count / SAMPLE + 1;
    out->point = malloc((p->pixel_count / step + 1) * sizeof *out->point);
    if (!out->point) return fail(MERLIN_NO_MEMORY, "no memory for %zu pixels", p->pixel_count);
    for (size_t i = 0; i < p->pixel_count; i += step)
        out->points += point_at(f, p->pixel[i], &out->point[out->points]);
    return out->points >= PST_FEWEST_PIXELS ? OK : pst_too_thin();
}

/* ---- steps ---- */

/* Takes one step of Levenberg and Marquardt; returns false if none reduces the cost. */
static bool take_step(const light_terms *t, double m[9], double *cost, double *damping)
{
    light_equations e;
    if (!isfinite(light_terms_cost(t, m, &e))) return false;
    for (int attempt = 0; attempt < TRIES; attempt++, *damping *= 4) {
        double damped[LIGHT_UNKNOWNS * LIGHT_UNKNOWNS], step[LIGHT_UNKNOWNS], moved[9];
        memcpy(damped, e.matrix, sizeof damped);
        memcpy(step, e.right, sizeof step);
        for (int j = 0; j < LIGHT_UNKNOWNS; j++)
            damped[j * (LIGHT_UNKNOWNS + 1)] += *damping * (e.matrix[j * (LIGHT_UNKNOWNS + 1)] + 1e-9);
        if (!dense_solve_positive(damped, LIGHT_UNKNOWNS, step)) continue;
        for (int j = 0; j < LIGHT_UNKNOWNS; j++)
            moved[j] = m[j] + step[j];
        const double value = light_terms_cost(t, moved, NULL);
        if (!(value < *cost)) continue;
        const bool goes_on = *cost - value > 1e-9 * *cost;
        memcpy(m, moved, sizeof moved);
        *cost = value;
        *damping /= 3;
        return goes_on;
    }
    return false;
}

static double descend(const light_terms *t, double m[9])
{
    double damping = 1e-2, cost = light_terms_cost(t, m, NULL);
    for (int i = 0; i < STEPS && take_step(t, m, &cost, &damping); i++)
        ;
    return cost;
}

/* ---- the start ---- */

/* Finds the matrix that makes the vectors most similar to the expected normals, and the lights of strength 1 in the
 * mean. */
static bool start_as_expected(const light_terms *f, int surface, double m[9])
{
    double gram[9] = {0}, dual[9], strength = 0;
    for (int r = 0; r < 3; r++) {
        double matrix[9] = {0}, right[3] = {0};
        for (size_t i = 0; i < f->points; i++) {
            const light_point *p = &f->point[i];
            const double b[3] = {p->b.x, p->b.y, p->b.z};
            const double n[3] = {p->like[surface].x, p->like[surface].y, p->like[surface].z};
            for (int j = 0; j < 3; j++) {
                right[j] += b[j] * n[r];
                for (int k = 0; k <= j; k++)
                    matrix[3 * j + k] += b[j] * b[k];
            }
        }
        if (!dense_solve_positive(matrix, 3, right)) return false;
        memcpy(gram + 3 * r, right, sizeof right);
    }
    if (!pst_dual(gram, dual)) return false;
    for (int k = 0; k < f->count; k++)
        strength += exact3_length(exact3_transform(dual, exact3_of(f->light[k]))) / f->count;
    for (int j = 0; j < 9; j++)
        m[j] = gram[j] * strength;
    return strength > 0 && isfinite(strength);
}

/* Returns the median of the residuals of integrability. */
static status ordinary_curl(light_terms *f, const double m[9])
{
    float *size = malloc((f->points + 1) * sizeof *size);
    if (!size) return fail(MERLIN_NO_MEMORY, "no memory for %zu pixels", f->points);
    for (size_t i = 0; i < f->points; i++) {
        const light_point *p = &f->point[i];
        const exact3 b = exact3_transform(m, p->b), x = exact3_transform(m, p->right), y = exact3_transform(m, p->up);
        size[i] = (float)sqrt((exact3_dot(x, x) + exact3_dot(y, y)) / fmax(exact3_dot(b, b), 1e-12));
    }
    qsort(size, f->points, sizeof *size, number_ascending);
    f->rough = (double)size[f->points / 2] + 1e-3;
    free(size);
    return OK;
}

static status fit_from_starts(light_terms *f, double best[9])
{
    double least = HUGE_VAL;
    status s = OK;
    for (int surface = 0; s == OK && surface < LIGHT_SURFACES; surface++) {
        double first[9];
        if (!start_as_expected(f, surface, first)) continue;
        if (!(f->rough > 0)) s = ordinary_curl(f, first);
        for (int i = 0; s == OK && i < HEIGHTS; i++) {
            double m[9];
            for (int j = 0; j < 9; j++)
                m[j] = first[j] * (j < 6 ? 1 : 1 / heights[i]);
            const double cost = descend(f, m);
            if (!(cost < least)) continue;
            least = cost;
            memcpy(best, m, sizeof m);
        }
    }
    if (s == OK && !(least < HUGE_VAL)) s = fail(MERLIN_BAD_INPUT, "the pictures do not tell where the lights are");
    return s;
}

/* Finds out whether the lights are of different strengths. */
static status compare_strengths(const light_terms *f, const double m[9], bool *differ)
{
    double dual[9];
    *differ = true;
    if (!pst_dual(m, dual)) return OK;
    float *size = malloc((size_t)f->count * sizeof *size);
    if (!size) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", f->count);
    for (int k = 0; k < f->count; k++)
        size[k] = (float)fabs(log(exact3_length(exact3_transform(dual, exact3_of(f->light[k]))) + 1e-12));
    qsort(size, (size_t)f->count, sizeof *size, number_ascending);
    *differ = (double)size[3 * f->count / 4] > unequal;
    free(size);
    return OK;
}

status pst_fit_lights(const pst_pseudo *pseudo, const vec3 *light, int count, double m[9], bool *uneven)
{
    const pst_expected *expected = pseudo->problem->expected;
    light_terms f = {
        .light = light, .expected_light = expected ? expected->light : NULL, .count = count, .uneven = even};
    status s = take_points(pseudo, &f);
    if (s == OK) s = fit_from_starts(&f, m);
    if (s == OK) s = compare_strengths(&f, m, uneven);
    f.uneven = given_up;
    if (s == OK && *uneven) s = fit_from_starts(&f, m);
    free(f.point);
    return s;
}
