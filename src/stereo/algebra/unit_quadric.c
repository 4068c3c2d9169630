/* SPDX-License-Identifier: MIT */
#include "stereo/algebra/unit_quadric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/algebra/dense.h"

enum { PASSES = 8, UNKNOWNS = 6 };
/* Least ratio of the quadric's smallest axis to its largest. */
static const double flattest = 0.02;

static double length_of(const double m[9], vec3 v)
{
    double square = 0;
    for (int j = 0; j < 9; j += 3) {
        double c = m[j] * (double)v.x + m[j + 1] * (double)v.y + m[j + 2] * (double)v.z;
        square += c * c;
    }
    return sqrt(square);
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Returns the median distance without six vectors, as many as unknowns, which any quadric can fit exactly and which
 * therefore say nothing. */
static double median_distance(const unit_quadric *q, const vec3 *v, size_t count, double *distance)
{
    for (size_t i = 0; i < count; i++)
        distance[i] = fabs(length_of(q->make, v[i]) - 1);
    qsort(distance, count, sizeof *distance, ascending);
    return distance[count > UNKNOWNS ? (count + UNKNOWNS) / 2 : count - 1];
}

/* Solves vᵀ Q v = 1, which is linear in the six numbers of Q, with weights by the last quadric's residuals (Cauchy). */
static status fit_once(const vec3 *v, size_t count, double width, unit_quadric *q)
{
    double form[36] = {0}, m[6] = {0}, eigenvalue[6];
    for (size_t i = 0; i < count; i++) {
        double x = (double)v[i].x, y = (double)v[i].y, z = (double)v[i].z;
        double row[6] = {x * x, 2 * x * y, 2 * x * z, y * y, 2 * y * z, z * z};
        double r = width < HUGE_VAL ? (length_of(q->make, v[i]) - 1) / width : 0, w = 1 / (1 + r * r);
        for (int j = 0; j < 36; j++)
            form[j] += w * row[j / 6] * row[j % 6];
        for (int j = 0; j < 6; j++)
            m[j] += w * row[j];
    }
    double axis[9];
    bool solved = dense_solve_positive(form, 6, m);
    memcpy(axis, &(double[9]){m[0], m[1], m[2], m[1], m[3], m[4], m[2], m[4], m[5]}, sizeof axis);
    if (!solved || !dense_eigen(axis, 3, true, eigenvalue) || !(eigenvalue[2] > 0))
        return fail(MERLIN_BAD_INPUT, "the pictures do not tell lights from surface: are the lights equally strong?");
    for (int j = 0; j < 9; j++) {
        /* not positive if highlights have distorted the factors */
        double root = sqrt(fmax(eigenvalue[j / 3], flattest * eigenvalue[2]));
        q->make[j] = root * axis[j % 3 * 3 + j / 3];
        q->dual[j] = axis[j % 3 * 3 + j / 3] / root;
    }
    return OK;
}

status unit_quadric_fit(const vec3 *v, size_t count, unit_quadric *out)
{
    double *distance = malloc(count * sizeof *distance);
    if (!distance) return fail(MERLIN_NO_MEMORY, "no memory for %zu vectors", count);
    status s = fit_once(v, count, HUGE_VAL, out);
    if (s == OK) out->spread = median_distance(out, v, count, distance);
    for (int pass = 0; s == OK && pass < PASSES; pass++) {
        s = fit_once(v, count, fmax(out->spread, 1e-4), out);
        if (s == OK) out->spread = median_distance(out, v, count, distance);
    }
    free(distance);
    return s;
}
