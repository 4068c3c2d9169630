/* SPDX-License-Identifier: MIT */
#include "stereo/fit/samples.h"

#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "stereo/algebra/dense.h"
#include "stereo/fit/field_fit.h"
#include "stereo/fit/lobe_fit.h"
#include "stereo/fit/pixel_fit.h"

/* Least number of lit pixels that span the lights; with fewer the shadowed ones are used, too. */
enum { ENOUGH = 24 };
/* Limits relative to a pixel's ordinary brightness: below is a shadow, above a highlight, which counts as this much. */
static const float dark = 0.05f, bright = 1.2f;
/* Limits of the lights' second eigenvalue as a share of the first: planes have up to 0.0004, and are certain below
 * 8-bit steps; surfaces that are not flat have 0.01 and more. Between the two the ratio to the fourth eigenvalue,
 * noise, decides: planes have up to 9, shallow reliefs 20 and more. */
static const double flat = 1e-3, flattest = 1e-5, above_noise = 15;
static const double above_rounding = 1e-9;

status pst_samples_new(const pst_problem *p, size_t count, pst_samples *out)
{
    *out = (pst_samples){.lights = p->capture->count, .padded = (size_t)pst_padded(p->capture->count)};
    status s = pst_field_sample(p, count, &out->pixel, &out->count);
    if (s != OK) return s;
    size_t floats = out->count * out->padded;
    out->value = malloc(3 * floats * sizeof(float));
    out->b = calloc(out->count, sizeof *out->b);
    if (!out->value || !out->b) {
        pst_samples_free(out);
        return fail(MERLIN_NO_MEMORY, "no memory for a sample of %zu pixels", count);
    }
    out->usable = out->value + floats;
    out->weight = out->usable + floats;
    pst_gather(p, out->pixel, out->count, out->value, out->usable, out->padded);
    return OK;
}

void pst_samples_free(pst_samples *m)
{
    free(m->pixel);
    free(m->value);
    free(m->b);
    *m = (pst_samples){0};
}

static pst_observations observed(const pst_samples *m, size_t i)
{
    return (pst_observations){
        .padded = (int)m->padded, .value = m->value + i * m->padded, .usable = m->usable + i * m->padded};
}

static bool is_lit(const pst_samples *m, size_t i, float level)
{
    const float *v = m->value + i * m->padded, *u = m->usable + i * m->padded;
    for (int k = 0; k < m->lights; k++)
        if (u[k] <= 0 || v[k] < dark * level) return false;
    return level > 0;
}

/* Adds a pixel. Pixels have equal weight whatever their albedo, and highlights no more than a bright diffuse value. */
static void add_pixel(const pst_samples *m, size_t i, float level, double *gram)
{
    size_t n = (size_t)m->lights;
    const float *v = m->value + i * m->padded;
    for (size_t j = 0; j < n; j++)
        for (size_t k = j; k < n; k++)
            gram[j * n + k] += (double)fminf(v[j] / level, bright) * (double)fminf(v[k] / level, bright);
}

/* Computes the lights' gram matrix, summed over the pixels that all lights reach, *lit of them; over all pixels if
 * these are few. */
static void fill_gram(const pst_samples *m, double *gram, size_t *lit)
{
    *lit = 0;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < m->count; i++) {
            pst_observations o = observed(m, i);
            float level = pst_ordinary_level(&o);
            bool all = is_lit(m, i, level);
            if (pass == 0) *lit += all;
            if (pass == 1 && level > 0 && (all || *lit < ENOUGH)) add_pixel(m, i, level, gram);
        }
}

status pst_samples_basis(const pst_samples *m, double *basis, size_t *lit)
{
    size_t n = (size_t)m->lights;
    double *gram = calloc(n * n + 2 * n, sizeof *gram);
    if (!gram) return fail(MERLIN_NO_MEMORY, "no memory for %zu lights", n);
    fill_gram(m, gram, lit);
    double *eigenvalue = gram + n * n;
    bool solved = dense_eigen(gram, m->lights, true, eigenvalue);
    double smallest = eigenvalue[n - 3], largest = eigenvalue[n - 1];
    for (size_t j = 0; j < n; j++)
        for (size_t k = 0; k < 3; k++)
            basis[3 * j + k] = gram[j * n + n - 1 - k] * sqrt(eigenvalue[n - 1 - k] > 0 ? eigenvalue[n - 1 - k] : 0);
    free(gram);
    if (!solved || !(smallest > above_rounding * largest))
        return fail(MERLIN_BAD_INPUT, "the pictures do not differ enough to tell the lights from the surface");
    return OK;
}

status pst_samples_differ(const pst_samples *m, bool *differ)
{
    size_t n = (size_t)m->lights, lit;
    double *gram = calloc(n * n + 2 * n, sizeof *gram);
    if (!gram) return fail(MERLIN_NO_MEMORY, "no memory for %zu lights", n);
    fill_gram(m, gram, &lit);
    double *eigenvalue = gram + n * n;
    bool solved = dense_eigen(gram, m->lights, false, eigenvalue);
    double share = eigenvalue[n - 2] / eigenvalue[n - 1];
    bool noise = n >= 4 && eigenvalue[n - 2] < above_noise * eigenvalue[n - 4];
    *differ = !solved || (share > flattest && (share > flat || !noise));
    free(gram);
    return OK;
}

typedef struct fit_job {
    pst_samples *m;
    const float *x, *y, *z;
} fit_job;

static void fit_one(void *context, size_t i)
{
    const fit_job *job = context;
    pst_samples *m = job->m;
    pst_observations o = {.padded = (int)m->padded,
                          .x = job->x,
                          .y = job->y,
                          .z = job->z,
                          .value = m->value + i * m->padded,
                          .usable = m->usable + i * m->padded};
    m->b[i] = pst_pixel_fit(&o, m->weight + i * m->padded).b;
}

void pst_samples_fit(pst_samples *m, const float *x, const float *y, const float *z)
{
    fit_job job = {m, x, y, z};
    parallel_for(m->count, fit_one, &job);
}
