/* SPDX-License-Identifier: MIT */
#include "stereo/uncalibrated/light_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "stereo/algebra/dense.h"

/* Number of pixels, of steps, and of tries with more damping. */
enum { SAMPLE = 2500, STEPS = 40, TRIES = 8, UNKNOWNS = 9, HEIGHTS = 3 };
/* Surfaces that the normals are compared with. */
enum { OUTLINE, EXPECTED, SURFACES };
/* Residuals at which a prior is about half given up: of the logarithm of a light's strength, of a unit vector's
 * distance from an expected normal, and from an expected light. */
static const double uneven = 0.02, unlike = 0.5, aside = 0.5;
/* Weights of integrability and of the inflated outline against that of the lights' strengths; the expected surface and
 * the expected lights count as much as these. docs/notes/several_photographs.md has the errors with other weights. */
static const double integrable_weight = 5, outline_weight = 2;
/* Heights of the starting surfaces relative to the one most similar to the expected surface. */
static const double heights[HEIGHTS] = {1, 1.7, 0.6};

/* A pixel: its unit vector, the vector's slopes, and the expected normals. */
typedef struct point {
    vec3 b, right, up, like[SURFACES]; /* zero where nothing is expected */
} point;

typedef struct fit {
    const vec3 *light, *expected_light; /* the second: unit times confidence; NULL: unknown */
    int count;
    point *point;
    size_t points;
    double rough;     /* ordinary residual of integrability */
    double *residual; /* two of each light, then three of each point */
    double *trial, *slope;
} fit;

static size_t residuals(const fit *f)
{
    return 2 * (size_t)f->count + (1 + SURFACES) * f->points;
}

/* ---- the pixels ---- */

static vec3 unit_at(const pst_pseudo *f, int32_t slot)
{
    return vec3_normalize(f->b[slot]);
}

static bool point_at(const pst_pseudo *f, size_t at, point *out)
{
    const int width = f->problem->capture->width, height = f->problem->capture->height;
    const int x = (int)(at % (size_t)width), y = (int)(at / (size_t)width);
    const int32_t *slot = f->slot + at;
    if (x < 1 || y < 1 || x + 1 >= width || y + 1 >= height) return false;
    if (slot[-1] < 0 || slot[1] < 0 || slot[-width] < 0 || slot[width] < 0) return false;
    out->b = unit_at(f, slot[0]);
    out->right = vec3_scale(vec3_sub(unit_at(f, slot[1]), unit_at(f, slot[-1])), 0.5f);
    out->up = vec3_scale(vec3_sub(unit_at(f, slot[-width]), unit_at(f, slot[width])), 0.5f);
    out->like[OUTLINE] = vec3_of(f->inflated->data + 3 * at);
    out->like[EXPECTED] = f->problem->expected ? vec3_of(f->problem->expected->normal->data + 3 * at) : (vec3){0, 0, 0};
    return isfinite(vec3_dot(out->b, out->b) + vec3_dot(out->right, out->up));
}

static status take_points(const pst_pseudo *f, fit *out)
{
    const pst_problem *p = f->problem;
    const size_t step = p->pixel_count / SAMPLE + 1;
    out->point = malloc((p->pixel_count / step + 1) * sizeof *out->point);
    if (!out->point) return fail(MERLIN_NO_MEMORY, "no memory for %zu pixels", p->pixel_count);
    for (size_t i = 0; i < p->pixel_count; i += step)
        out->points += point_at(f, p->pixel[i], &out->point[out->points]);
    return out->points >= PST_FEWEST_PIXELS ? OK : pst_too_thin();
}

/* ---- residuals ---- */

/* Computes b3 ∂y b1 − b1 ∂y b3 − b3 ∂x b2 + b2 ∂x b3 of transformed vectors, over b's square (integrable.h). */
static double curl(const double m[9], const point *p)
{
    const vec3 b = pst_transform(m, p->b), x = pst_transform(m, p->right), y = pst_transform(m, p->up);
    return (double)(b.z * y.x - b.x * y.z - b.z * x.y + b.y * x.z) / fmax((double)vec3_dot(b, b), 1e-12);
}

bool pst_dual(const double m[9], double out[9])
{
    double determinant = 0;
    for (int i = 0; i < 9; i++) {
        const int r = i / 3, c = i % 3, r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
        out[i] = m[3 * r1 + c1] * m[3 * r2 + c2] - m[3 * r1 + c2] * m[3 * r2 + c1];
        if (r == 0) determinant += m[i] * out[i];
    }
    if (!(fabs(determinant) > 1e-12) || !isfinite(determinant)) return false;
    for (int i = 0; i < 9; i++)
        out[i] /= determinant;
    return true;
}

static double unlikeness(vec3 normal, vec3 like)
{
    if (!(vec3_dot(like, like) > 0)) return 0;
    return tanh((double)vec3_length(vec3_sub(normal, like)) / unlike);
}

static double direction_residual(vec3 light, vec3 expected)
{
    const real sure = vec3_length(expected);
    if (!(sure > 0)) return 0;
    const vec3 off = vec3_sub(vec3_normalize(light), vec3_scale(expected, 1 / sure));
    return (double)sure * tanh((double)vec3_length(off) / aside);
}

static bool compute(const fit *f, const double m[9], double *out)
{
    double dual[9];
    if (!pst_dual(m, dual)) return false;
    const double share = (double)f->count / (double)f->points;
    const double along = sqrt(integrable_weight * share), like = sqrt(share), outline = sqrt(outline_weight);
    for (int k = 0; k < f->count; k++) {
        const vec3 light = pst_transform(dual, f->light[k]);
        *out++ = atan(log(fmax((double)vec3_length(light), 1e-12)) / uneven);
        *out++ = f->expected_light ? direction_residual(light, f->expected_light[k]) : 0;
    }
    for (size_t i = 0; i < f->points; i++) {
        const point *p = &f->point[i];
        const vec3 normal = vec3_normalize(pst_transform(m, p->b));
        *out++ = along * tanh(curl(m, p) / f->rough);
        for (int k = 0; k < SURFACES; k++)
            *out++ = (k == OUTLINE ? outline : 1) * like * unlikeness(normal, p->like[k]);
    }
    return true;
}

static double squares(const double *r, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += r[i] * r[i];
    return sum;
}

/* ---- steps ---- */

/* Makes the normal equations by forward differences. */
static bool equations(const fit *f, const double m[9], double matrix[UNKNOWNS * UNKNOWNS], double right[UNKNOWNS])
{
    const size_t n = residuals(f);
    const double step = 1e-5;
    for (int j = 0; j < UNKNOWNS; j++) {
        double moved[9], *slope = f->slope + (size_t)j * n;
        memcpy(moved, m, sizeof moved);
        moved[j] += step;
        if (!compute(f, moved, slope)) return false;
        for (size_t i = 0; i < n; i++)
            slope[i] = (slope[i] - f->residual[i]) / step;
    }
    for (int j = 0; j < UNKNOWNS; j++) {
        right[j] = 0;
        for (size_t i = 0; i < n; i++)
            right[j] -= f->slope[(size_t)j * n + i] * f->residual[i];
        for (int k = 0; k <= j; k++) {
            double sum = 0;
            for (size_t i = 0; i < n; i++)
                sum += f->slope[(size_t)j * n + i] * f->slope[(size_t)k * n + i];
            matrix[j * UNKNOWNS + k] = sum;
        }
    }
    return true;
}

/* Takes one step of Levenberg and Marquardt; returns false if none reduces the cost. */
static bool take_step(fit *f, double m[9], double *cost, double *damping)
{
    double matrix[UNKNOWNS * UNKNOWNS], right[UNKNOWNS];
    if (!equations(f, m, matrix, right)) return false;
    for (int attempt = 0; attempt < TRIES; attempt++, *damping *= 4) {
        double damped[UNKNOWNS * UNKNOWNS], step[UNKNOWNS], moved[9];
        memcpy(damped, matrix, sizeof damped);
        memcpy(step, right, sizeof step);
        for (int j = 0; j < UNKNOWNS; j++)
            damped[j * (UNKNOWNS + 1)] += *damping * (matrix[j * (UNKNOWNS + 1)] + 1e-9);
        if (!dense_solve_positive(damped, UNKNOWNS, step)) continue;
        for (int j = 0; j < UNKNOWNS; j++)
            moved[j] = m[j] + step[j];
        if (!compute(f, moved, f->trial)) continue;
        const double value = squares(f->trial, residuals(f));
        if (!(value < *cost)) continue;
        const bool goes_on = *cost - value > 1e-9 * *cost;
        memcpy(m, moved, sizeof moved);
        memcpy(f->residual, f->trial, residuals(f) * sizeof *f->trial);
        *cost = value;
        *damping /= 3;
        return goes_on;
    }
    return false;
}

static double descend(fit *f, double m[9])
{
    double damping = 1e-2;
    if (!compute(f, m, f->residual)) return HUGE_VAL;
    double cost = squares(f->residual, residuals(f));
    for (int i = 0; i < STEPS && take_step(f, m, &cost, &damping); i++)
        ;
    return cost;
}

/* ---- the start ---- */

/* Finds the matrix that makes the vectors most similar to the expected normals, and the lights of strength 1 in the
 * mean. */
static bool start_as_expected(const fit *f, int surface, double m[9])
{
    double gram[9] = {0}, dual[9], strength = 0;
    for (int r = 0; r < 3; r++) {
        double matrix[9] = {0}, right[3] = {0};
        for (size_t i = 0; i < f->points; i++) {
            const point *p = &f->point[i];
            const double b[3] = {p->b.x, p->b.y, p->b.z},
                         n[3] = {p->like[surface].x, p->like[surface].y, p->like[surface].z};
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
        strength += (double)vec3_length(pst_transform(dual, f->light[k])) / f->count;
    for (int j = 0; j < 9; j++)
        m[j] = gram[j] * strength;
    return strength > 0 && isfinite(strength);
}

/* Returns the median of the residuals of integrability. */
static status ordinary_curl(fit *f, const double m[9])
{
    float *size = malloc((f->points + 1) * sizeof *size);
    if (!size) return fail(MERLIN_NO_MEMORY, "no memory for %zu pixels", f->points);
    for (size_t i = 0; i < f->points; i++) {
        const vec3 b = pst_transform(m, f->point[i].b), x = pst_transform(m, f->point[i].right),
                   y = pst_transform(m, f->point[i].up);
        size[i] = sqrtf((vec3_dot(x, x) + vec3_dot(y, y)) / fmaxf(vec3_dot(b, b), 1e-12f));
    }
    qsort(size, f->points, sizeof *size, number_ascending);
    f->rough = (double)size[f->points / 2] + 1e-3;
    free(size);
    return OK;
}

static status fit_from_starts(fit *f, double best[9])
{
    double least = HUGE_VAL;
    status s = OK;
    for (int surface = 0; s == OK && surface < SURFACES; surface++) {
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

status pst_fit_lights(const pst_pseudo *pseudo, const vec3 *light, int count, double m[9])
{
    const pst_expected *expected = pseudo->problem->expected;
    fit f = {.light = light, .expected_light = expected ? expected->light : NULL, .count = count};
    status s = take_points(pseudo, &f);
    const size_t n = residuals(&f);
    if (s == OK) {
        f.residual = malloc((UNKNOWNS + 2) * n * sizeof *f.residual);
        f.trial = f.residual ? f.residual + n : NULL;
        f.slope = f.residual ? f.trial + n : NULL;
        s = f.residual ? fit_from_starts(&f, m) : fail(MERLIN_NO_MEMORY, "no memory for %zu pixels", f.points);
    }
    free(f.residual);
    free(f.point);
    return s;
}
