/* SPDX-License-Identifier: MIT */
#include "stereo/uncalibrated/light_terms.h"

#include <string.h>

/* Residuals at which a prior is about half given up: of a unit vector's distance from an expected normal, and from an
 * expected light. */
static const double unlike = 0.5, aside = 0.5;
/* Weights of integrability and of the inflated outline against that of the lights' strengths; the expected surface and
 * the expected lights count as much as these. docs/notes/several_photographs.md has the errors with other weights. */
static const double integrable_weight = 5, outline_weight = 2;

/* A residual and its derivatives by the matrix's elements. */
typedef struct term {
    double residual, slope[LIGHT_UNKNOWNS];
} term;

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

/* Adds the derivative of g · (m v) by m. */
static void add_product(exact3 g, exact3 v, double slope[LIGHT_UNKNOWNS])
{
    const double row[3] = {g.x, g.y, g.z}, column[3] = {v.x, v.y, v.z};
    for (int i = 0; i < LIGHT_UNKNOWNS; i++)
        slope[i] += row[i / 3] * column[i % 3];
}

/* ---- what a light has to satisfy ---- */

/* Adds the derivative of g · light by m, where light is the dual times a constant. A change D of m changes it by
 * -dual Dᵀ light. */
static void add_dual_product(exact3 g, const double dual[9], exact3 light, double slope[LIGHT_UNKNOWNS])
{
    const double row[3] = {light.x, light.y, light.z};
    for (int i = 0; i < LIGHT_UNKNOWNS; i++) {
        const int c = i % 3;
        slope[i] -= row[i / 3] * (g.x * dual[c] + g.y * dual[3 + c] + g.z * dual[6 + c]);
    }
}

static term strength_term(exact3 light, const double dual[9], double uneven)
{
    const double square = fmax(exact3_dot(light, light), 1e-24), off = log(square) / (2 * uneven);
    term out = {.residual = atan(off)};
    add_dual_product(exact3_scale(light, 1 / (square * uneven * (1 + off * off))), dual, light, out.slope);
    return out;
}

/* Returns the derivative by v of |v/|v| - like|, from the unit vector n of v, its length, and the distance. */
static exact3 distance_slope(exact3 n, double length, exact3 like, double distance)
{
    const double along = exact3_dot(n, like);
    return exact3_scale(exact3_sub(exact3_scale(n, along), like), 1 / fmax(length * distance, 1e-12));
}

static term direction_term(exact3 light, exact3 expected, const double dual[9])
{
    term out = {0};
    const double sure = exact3_length(expected);
    if (!(sure > 0)) return out;
    const exact3 n = exact3_normalize(light), like = exact3_scale(expected, 1 / sure);
    const double distance = exact3_length(exact3_sub(n, like)), kept = tanh(distance / aside);
    out.residual = sure * kept;
    const exact3 g = distance_slope(n, exact3_length(light), like, distance);
    add_dual_product(exact3_scale(g, sure * (1 - kept * kept) / aside), dual, light, out.slope);
    return out;
}

/* ---- what a pixel has to satisfy ---- */

/* Compares b3 ∂y b1 − b1 ∂y b3 − b3 ∂x b2 + b2 ∂x b3, over b's square (integrable.h), with an ordinary one. */
static term curl_term(const light_terms *t, const light_point *p, const double m[9], exact3 b)
{
    const exact3 x = exact3_transform(m, p->right), y = exact3_transform(m, p->up);
    const double square = fmax(exact3_dot(b, b), 1e-12);
    const double curl = (b.z * y.x - b.x * y.z - b.z * x.y + b.y * x.z) / square, kept = tanh(curl / t->rough);
    const double by = (1 - kept * kept) / (t->rough * square);
    term out = {.residual = kept};
    const exact3 by_b = {-y.z - 2 * curl * b.x, x.z - 2 * curl * b.y, y.x - x.y - 2 * curl * b.z};
    add_product(exact3_scale(by_b, by), p->b, out.slope);
    add_product((exact3){0, -b.z * by, b.y * by}, p->right, out.slope);
    add_product((exact3){b.z * by, 0, -b.x * by}, p->up, out.slope);
    return out;
}

static term normal_term(exact3 b, exact3 like, exact3 of)
{
    term out = {0};
    if (!(exact3_dot(like, like) > 0)) return out;
    const exact3 n = exact3_normalize(b);
    const double distance = exact3_length(exact3_sub(n, like)), kept = tanh(distance / unlike);
    out.residual = kept;
    const exact3 g = distance_slope(n, exact3_length(b), like, distance);
    add_product(exact3_scale(g, (1 - kept * kept) / unlike), of, out.slope);
    return out;
}

/* ---- their sum ---- */

static double take(const term *t, double weight, light_equations *e)
{
    for (int i = 0; e && i < LIGHT_UNKNOWNS; i++) {
        e->right[i] -= weight * t->residual * t->slope[i];
        for (int j = 0; j <= i; j++)
            e->matrix[LIGHT_UNKNOWNS * i + j] += weight * t->slope[i] * t->slope[j];
    }
    return weight * t->residual * t->residual;
}

double light_terms_cost(const light_terms *t, const double m[9], light_equations *equations)
{
    double dual[9], cost = 0;
    if (!pst_dual(m, dual)) return HUGE_VAL;
    if (equations) memset(equations, 0, sizeof *equations);
    for (int k = 0; k < t->count; k++) {
        const exact3 light = exact3_transform(dual, exact3_of(t->light[k]));
        const term strength = strength_term(light, dual, t->uneven);
        cost += take(&strength, 1, equations);
        if (!t->expected_light) continue;
        const term direction = direction_term(light, exact3_of(t->expected_light[k]), dual);
        cost += take(&direction, 1, equations);
    }
    const double share = (double)t->count / (double)t->points;
    for (size_t i = 0; i < t->points; i++) {
        const light_point *p = &t->point[i];
        const exact3 b = exact3_transform(m, p->b);
        const term curl = curl_term(t, p, m, b);
        cost += take(&curl, integrable_weight * share, equations);
        for (int k = 0; k < LIGHT_SURFACES; k++) {
            const term normal = normal_term(b, p->like[k], p->b);
            cost += take(&normal, share * (k == LIGHT_OUTLINE ? outline_weight : 1), equations);
        }
    }
    return cost;
}
