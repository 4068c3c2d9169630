/* SPDX-License-Identifier: MIT */
/* A pixel's value under light k is m = e_k l_k · b. With x = 1/e this is linear in x and b together: m_k x_k = l_k · b
 * (D. Cho, Y. Matsushita, Y.-W. Tai, I. S. Kweon, Photometric stereo under non-uniform light intensities and exposures,
 * ECCV 2016). Each pixel's b is eliminated by projection (G. Golub, V. Pereyra, SIAM J. Numer. Anal. 10, 1973), so that
 * shadows and highlights can be left out pixel by pixel; the sum over all pixels is a quadratic form in x, and x its
 * smallest eigenvector. Weights come from the robust fit under the previous intensities. */
#include "stereo/methods/intensities.h"
#include "base/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/algebra/dense.h"
#include "stereo/algebra/matrix3.h"
#include "stereo/fit/lobe_fit.h"
#include "stereo/fit/pixel_fit.h"
#include "stereo/fit/samples.h"

enum { ROUNDS = 40, FITS = 3 };
/* First and last width of the loss, as a share of the albedo. */
static const float widest = 0.8f, narrowest = 0.1f;
/* Limits of shadows and highlights, relative to a pixel's ordinary brightness. */
static const float dark = 0.15f, bright = 1.5f;
/* Rounds end when no intensity changes by more than this share. */
static const double settled = 1e-3;
/* Share of the others' weight below which a light is considered to be in shadow everywhere, because its estimate is too
 * low. */
static const double forgotten = 1e-2;
/* Largest deviation from equal intensities; larger ones are a failure of the form, not lamps. */
static const double most_apart = 10;

typedef struct intensities_job {
    const pst_problem *problem;
    pst_samples sample;
    float *level, *ratio; /* per pixel of the sample */
    double *form, *own;   /* lights × lights, lower half; its diagonal before the projection */
    double *eigenvalue, *next;
} intensities_job;

void pst_intensities_normalize(double *e, int count)
{
    double mean = 0;
    for (int k = 0; k < count; k++)
        mean += e[k] / count;
    for (int k = 0; k < count; k++)
        e[k] /= mean;
}

double pst_intensities_about(const float *ratio, size_t count, double middle)
{
    static const double width = 0.1;
    for (int round = 0; count > 0 && round < 5; round++) {
        double sum = 0, weights = 0;
        for (size_t i = 0; i < count; i++) {
            double r = ((double)ratio[i] / middle - 1) / width, w = 1 / ((1 + r * r) * (1 + r * r));
            sum += w * (double)ratio[i];
            weights += w;
        }
        middle = fmax(sum / weights, 1e-6);
    }
    return middle;
}

double pst_intensities_typical(float *ratio, size_t count)
{
    if (count == 0) return 1;
    qsort(ratio, count, sizeof *ratio, number_ascending);
    return pst_intensities_about(ratio, count, fmax((double)ratio[count / 2], 1e-6));
}

/* Fits the pixel's surface by its weights, and sets the weights by the residuals; lights that are dark relative to the
 * pixel's ordinary brightness are in its shadow, whatever their intensity. */
static void fit_pixel(intensities_job *job, size_t i, const double *e, float width)
{
    pst_samples *m = &job->sample;
    const float *value = m->value + i * m->padded, *usable = m->usable + i * m->padded;
    float *weight = m->weight + i * m->padded, a[6] = {0}, level = job->level[i];
    vec3 right = {0, 0, 0};
    for (int k = 0; k < m->lights; k++) {
        vec3 d = vec3_of(job->problem->light[k].direction), s = vec3_scale(d, weight[k]);
        pst_add_outer3(a, s, d);
        right = vec3_fma(right, value[k] / (float)e[k], s);
    }
    m->b[i] = pst_solve3(a, right);
    float scale = width * vec3_length(m->b[i]) + 1e-12f;
    for (int k = 0; k < m->lights; k++) {
        float seen = value[k] / (float)e[k],
              r = (seen - vec3_dot(m->b[i], vec3_of(job->problem->light[k].direction))) / scale;
        weight[k] = usable[k] > 0 && value[k] > dark * level ? 1 / ((1 + r * r) * (1 + r * r)) : 0;
    }
}

/* Adds one pixel's part of the form, Mᵀ (W − W L (Lᵀ W L)⁻¹ Lᵀ W) M, whatever its albedo. */
static void add_pixel(intensities_job *job, size_t i)
{
    const merlin_light *light = job->problem->light;
    const pst_samples *m = &job->sample;
    const float *value = m->value + i * m->padded, *weight = m->weight + i * m->padded;
    float a[6] = {0}, level = vec3_length(m->b[i]);
    int n = m->lights;
    vec3 row[PST_MAX_LIGHTS]; /* W M L */
    if (!(level > 0)) return;
    for (int k = 0; k < n; k++) {
        vec3 d = vec3_of(light[k].direction), s = vec3_scale(d, weight[k]);
        float seen = value[k] / level;
        pst_add_outer3(a, s, d);
        row[k] = vec3_scale(s, seen);
        job->own[k] += (double)(weight[k] * seen * seen);
    }
    for (int k = 0; k < n; k++) {
        if (!(weight[k] > 0)) continue;
        vec3 u = pst_solve3(a, row[k]);
        for (int j = 0; j <= k; j++)
            job->form[k * n + j] -= (double)vec3_dot(u, row[j]);
    }
}

/* Returns the intensity by the surface, for a light that no pixel's fit uses. */
static double from_surface(intensities_job *job, int k)
{
    const pst_samples *m = &job->sample;
    size_t count = 0;
    for (size_t i = 0; i < m->count; i++) {
        float shading = vec3_dot(m->b[i], vec3_of(job->problem->light[k].direction));
        if (m->usable[i * m->padded + (size_t)k] > 0 && shading > PST_WELL_LIT * vec3_length(m->b[i]))
            job->ratio[count++] = m->value[i * m->padded + (size_t)k] / shading;
    }
    return pst_intensities_typical(job->ratio, count);
}

/* Scales the form to a unit diagonal, upper half only; own becomes the square root of the divisor, 0 for lights without
 * weight, which are removed from it. */
static void scale_form(intensities_job *job)
{
    int n = job->sample.lights;
    double mean = 0;
    for (int k = 0; k < n; k++) {
        job->form[k * n + k] += job->own[k];
        mean += job->own[k] / n;
    }
    for (int k = 0; k < n; k++)
        job->own[k] = job->own[k] > forgotten * mean ? sqrt(job->own[k]) : 0;
    for (int k = 0; k < n; k++)
        for (int j = 0; j <= k; j++) {
            double scale = job->own[k] * job->own[j];
            job->form[j * n + k] = scale > 0 ? job->form[k * n + j] / scale : k == j;
        }
}

/* Finds the smallest eigenvector, shifted toward equal intensities as far as other eigenvalues are hardly larger: on a
 * surface whose normals hardly differ, intensities and albedo are ambiguous. */
static status solve_form(intensities_job *job)
{
    int n = job->sample.lights;
    scale_form(job);
    if (!dense_eigen(job->form, n, true, job->eigenvalue))
        return fail(MERLIN_BAD_INPUT, "the lights' intensities cannot be told from these pictures");
    double least = fmax(job->eigenvalue[0], 1e-12);
    memset(job->next, 0, (size_t)n * sizeof *job->next);
    for (int j = 0; j < n; j++) {
        double share = 0;
        for (int k = 0; k < n; k++)
            share += job->form[k * n + j] * job->own[k];
        share *= least / fmax(job->eigenvalue[j], least);
        for (int k = 0; k < n; k++)
            job->next[k] += share * job->form[k * n + j];
    }
    return OK;
}

/* Improves the intensities; *moved: the largest change. */
static status improve(intensities_job *job, float width, double *e, double *moved)
{
    int n = job->sample.lights;
    for (size_t i = 0; i < job->sample.count; i++)
        for (int k = 0; k < FITS; k++)
            fit_pixel(job, i, e, width);
    memset(job->form, 0, (size_t)n * (size_t)(n + 1) * sizeof *job->form); /* own follows it in memory */
    for (size_t i = 0; i < job->sample.count; i++)
        add_pixel(job, i);
    status s = solve_form(job);
    if (s != OK) return s;
    for (int k = 0; k < n; k++) {
        double found = job->own[k] / job->next[k];
        bool sane = job->own[k] > 0 && found < most_apart && found > 1 / most_apart;
        job->next[k] = sane ? found : from_surface(job, k);
    }
    pst_intensities_normalize(job->next, n);
    *moved = 0;
    for (int k = 0; k < n; k++) {
        *moved = fmax(*moved, fabs(job->next[k] / e[k] - 1));
        e[k] = job->next[k];
    }
    return OK;
}

/* Gives weight to what would be neither shadow nor highlight if the lights were equally strong. */
static void start_weights(intensities_job *job)
{
    pst_samples *m = &job->sample;
    for (size_t i = 0; i < m->count; i++) {
        const float *value = m->value + i * m->padded, *usable = m->usable + i * m->padded;
        pst_observations o = {.padded = (int)m->padded, .value = value, .usable = usable};
        job->level[i] = pst_ordinary_level(&o);
        for (int k = 0; k < m->lights; k++)
            m->weight[i * m->padded + (size_t)k] =
                usable[k] > 0 && value[k] > dark * job->level[i] && value[k] < bright * job->level[i];
    }
}

static status job_new(const pst_problem *p, size_t sample, intensities_job *job)
{
    status s = pst_samples_new(p, sample, &job->sample);
    if (s != OK) return s;
    size_t n = (size_t)job->sample.lights;
    job->problem = p;
    job->level = calloc(2 * job->sample.count, sizeof *job->level);
    job->form = malloc(n * (n + 4) * sizeof *job->form);
    if (!job->level || !job->form) return fail(MERLIN_NO_MEMORY, "no memory for %zu lights", n);
    job->ratio = job->level + job->sample.count;
    job->own = job->form + n * n;
    job->eigenvalue = job->own + n;
    job->next = job->eigenvalue + 2 * n;
    start_weights(job);
    return OK;
}

status pst_intensities_find(const pst_problem *p, size_t sample, double *e, double *uniqueness)
{
    intensities_job job = {0};
    double moved = HUGE_VAL;
    for (int k = 0; k < p->capture->count; k++)
        e[k] = 1;
    status s = job_new(p, sample, &job);
    for (int round = 0; s == OK && round < ROUNDS && moved > settled; round++)
        s = improve(&job, fmaxf(narrowest, widest / (float)(1 << (round < 8 ? round : 8))), e, &moved);
    if (s == OK) *uniqueness = job.eigenvalue[1] / fmax(job.eigenvalue[0], 1e-12);
    pst_samples_free(&job.sample);
    free(job.level);
    free(job.form);
    return s;
}
