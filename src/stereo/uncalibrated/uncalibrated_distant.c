/* SPDX-License-Identifier: MIT */
/* Estimates distant lights of unknown direction.
 *
 * 1. The matrix of values is factored into lights and surface by its singular vectors, with highlights cut off; the
 *    factors are then refitted by robust weights, because shadows and highlights are not of rank three. An unknown 3×3
 *    matrix remains between the factors.
 * 2. Prior: most lights have equal strength or, if that is impossible or the alternative is much more exact, most of
 * the
 *    surface has one albedo. A rotation or reflection remains (unit_quadric.h).
 * 3. It is found by integrability and by the outline (integrable.h). If the problem has an expected surface, it, the
 *    lights' strengths and integrability determine all of the matrix instead (light_fit.h).
 * 4. With the lights and their strengths known, the robust solver does the rest. */
#include <math.h>
#include <stdlib.h>

#include "stereo/algebra/matrix3.h"
#include "stereo/algebra/unit_quadric.h"
#include "stereo/fit/field_fit.h"
#include "stereo/fit/pixel_fit.h"
#include "stereo/fit/samples.h"
#include "stereo/uncalibrated/integrable.h"
#include "stereo/uncalibrated/light_fit.h"
#include "stereo/uncalibrated/light_terms.h"
#include "stereo/uncalibrated/uncalibrated_parts.h"

enum { SAMPLE = 1500, REFITS = 30 };

/* Variation of lights' strengths above which they are not considered equal, unless it is less than this many times that
 * of the surface's albedos: noise alone makes albedos vary three times more, one albedo under unequal lights half as
 * much or less. */
static const double uneven = 0.07, plainly = 2;

typedef struct lights3 {
    int count;
    float *x, *y, *z; /* padded */
} lights3;

/* Fits each light to the surface with the surface's weights. */
static void refit_lights(const pst_samples *m, lights3 *l)
{
    for (int k = 0; k < l->count; k++) {
        float a[6] = {0};
        vec3 right = {0, 0, 0};
        for (size_t i = 0; i < m->count; i++) {
            /* equal weight whatever the albedo */
            vec3 b = m->b[i];
            float w = m->weight[i * m->padded + (size_t)k] / fmaxf(vec3_dot(b, b), 1e-12f);
            pst_add_outer3(a, vec3_scale(b, w), b);
            right = vec3_fma(right, w * m->value[i * m->padded + (size_t)k], b);
        }
        vec3 found = pst_solve3(a, right);
        l->x[k] = found.x;
        l->y[k] = found.y;
        l->z[k] = found.z;
    }
}

static status factor(const pst_problem *p, lights3 *l)
{
    pst_samples m;
    status s = pst_samples_new(p, SAMPLE, &m);
    if (s != OK) return s;
    double *basis = calloc((size_t)l->count * 3, sizeof *basis), mean[3] = {0};
    size_t lit = 0;
    s = basis ? pst_samples_basis(&m, basis, &lit) : fail(MERLIN_NO_MEMORY, "no memory for %d lights", l->count);
    for (int k = 0; s == OK && k < 3 * l->count; k++)
        mean[k % 3] += basis[k] * basis[k] / l->count;
    for (int k = 0; s == OK && k < l->count; k++) {
        /* whitened: the robust fit's widths are shares of |b|, which must mean the same in all directions */
        l->x[k] = (float)(basis[3 * k] / sqrt(3 * mean[0]));
        l->y[k] = (float)(basis[3 * k + 1] / sqrt(3 * mean[1]));
        l->z[k] = (float)(basis[3 * k + 2] / sqrt(3 * mean[2]));
    }
    for (int k = 0; s == OK && k < REFITS; k++) {
        pst_samples_fit(&m, l->x, l->y, l->z);
        refit_lights(&m, l);
    }
    free(basis);
    pst_samples_free(&m);
    return s;
}

static vec3 mean_light(const lights3 *l)
{
    vec3 sum = {0, 0, 0};
    for (int k = 0; k < l->count; k++)
        sum = vec3_add(sum, vec3_make(l->x[k], l->y[k], l->z[k]));
    return vec3_normalize(sum);
}

static void transform_lights(const double m[9], lights3 *l)
{
    for (int k = 0; k < l->count; k++) {
        vec3 v = pst_transform(m, vec3_make(l->x[k], l->y[k], l->z[k]));
        l->x[k] = v.x;
        l->y[k] = v.y;
        l->z[k] = v.z;
    }
}

/* Transforms the lights to equal strength or, if that is impossible or the surface plainly has one albedo, the surface
 * to equal albedo; up to a rotation. */
static status straighten(pst_pseudo *f, lights3 *l)
{
    unit_quadric strength, albedo;
    size_t n = f->problem->pixel_count;
    vec3 *light = malloc((size_t)l->count * sizeof *light);
    if (!light) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", l->count);
    for (int k = 0; k < l->count; k++)
        light[k] = vec3_make(l->x[k], l->y[k], l->z[k]);
    status s = unit_quadric_fit(light, (size_t)l->count, &strength);
    free(light);
    if (s != OK) return s;
    s = unit_quadric_fit(f->b, n, &albedo);
    if (s == MERLIN_NO_MEMORY) return s;
    double albedos = s == OK ? albedo.spread : HUGE_VAL;
    bool by_albedo = strength.spread > fmin(uneven, plainly * albedos);
    if (by_albedo && albedos > strength.spread)
        return fail(MERLIN_BAD_INPUT,
                    "the lights are not equally strong, nor is the surface of one albedo: where the lights "
                    "are cannot be told; state their intensities in light_intensities.txt");
    transform_lights(by_albedo ? albedo.dual : strength.make, l);
    for (size_t i = 0; i < n; i++)
        f->b[i] = pst_transform(by_albedo ? albedo.make : strength.dual, f->b[i]);
    return OK;
}

/* Converts the pseudo lights to directions with a surface that is expected not by its outline alone, so that no prior
 * needs to be exact. */
static status resolve_as_expected(pst_pseudo *f, lights3 *l, pst_rotation *rotation)
{
    double dual[9];
    vec3 *light = malloc((size_t)l->count * sizeof *light);
    if (!light) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", l->count);
    for (int k = 0; k < l->count; k++)
        light[k] = vec3_make(l->x[k], l->y[k], l->z[k]);
    status s = pst_average_surface(f);
    if (s == OK) s = pst_fit_lights(f, light, l->count, rotation->at, &rotation->uneven);
    free(light);
    if (s != OK) return s;
    if (!pst_dual(rotation->at, dual)) return fail(MERLIN_BAD_INPUT, "the pictures do not tell where the lights are");
    transform_lights(dual, l);
    return OK;
}

/* Converts the pseudo lights to directions. */
static status resolve(pst_pseudo *f, lights3 *l, pst_rotation *rotation)
{
    *rotation = (pst_rotation){.unsure = false};
    if (f->problem->expected) return resolve_as_expected(f, l, rotation);
    status s = straighten(f, l);
    if (s == OK) s = pst_find_rotation(f, mean_light(l), rotation);
    if (s == OK) transform_lights(rotation->at, l);
    return s;
}

/* Computes the surface under the pseudo lights at every pixel. */
static status pseudo_surface(const pst_problem *p, const lights3 *l, pst_pseudo *f)
{
    pst_field field = {.problem = p, .pixel = p->pixel, .count = p->pixel_count};
    f->problem = p;
    f->b = field.b = malloc(p->pixel_count * sizeof *f->b);
    f->slot = pst_field_slots(&field);
    merlin_light *light = malloc((size_t)l->count * sizeof *light);
    status s = f->b && f->slot && light ? OK : fail(MERLIN_NO_MEMORY, "no memory for %zu pixels", p->pixel_count);
    if (s == OK) {
        for (int k = 0; k < l->count; k++) {
            light[k] = p->light[k];
            vec3_put(vec3_make(l->x[k], l->y[k], l->z[k]), light[k].direction);
        }
        pst_problem under = *p;
        under.light = light;
        field.problem = &under;
        double cost;
        s = pst_field_fit(&field, &cost);
    }
    free(light);
    return s;
}

static status name_lights(const pst_problem *p, const lights3 *l, merlin_light *light)
{
    double mean = 0;
    for (int k = 0; k < l->count; k++)
        mean += vec3_length(vec3_make(l->x[k], l->y[k], l->z[k])) / l->count;
    for (int k = 0; k < l->count; k++) {
        vec3 v = vec3_make(l->x[k], l->y[k], l->z[k]);
        light[k] = p->light[k];
        vec3_put(vec3_normalize(v), light[k].direction);
        for (int ch = 0; ch < 3; ch++)
            light[k].intensity[ch] *= fmaxf(vec3_length(v) / (float)mean, 1e-6f);
    }
    return pst_check_directions(light, l->count);
}

status pst_find_distant_lights(const pst_problem *p, const img *inflated, merlin_light *light, pst_rotation *rotation)
{
    if (p->pixel_count < PST_FEWEST_PIXELS) return pst_too_thin();
    int count = p->capture->count;
    size_t padded = (size_t)pst_padded(count);
    pst_pseudo f = {.inflated = inflated};
    lights3 l = {.count = count, .x = calloc(3 * padded, sizeof(float))};
    if (!l.x) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", count);
    l.y = l.x + padded;
    l.z = l.y + padded;
    status s = factor(p, &l);
    if (s == OK) s = pseudo_surface(p, &l, &f);
    if (s == OK) s = resolve(&f, &l, rotation);
    if (s == OK) s = name_lights(p, &l, light);
    free(l.x);
    free(f.b);
    free(f.slot);
    return s;
}
