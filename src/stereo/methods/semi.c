/* SPDX-License-Identifier: MIT */
/* Photometric stereo with known light directions and unknown intensities (D. Cho, Y. Matsushita, Y.-W. Tai, I. S.
 * Kweon, Semi-calibrated photometric stereo, ECCV 2016 and PAMI 2018).
 *
 * There are two starts, the intensities by Lambert's law (intensities.h) and equal ones; from each, intensities and the
 * surface of a sample including its highlights (lobe_fit.h) are updated in turn. The result that explains the sample
 * best is used. The mean intensity is 1. On a surface whose normals hardly differ, intensities and albedo are
 * ambiguous: equal ones are kept unless others explain the pictures much better. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/fit/lobe_choice.h"
#include "stereo/methods/intensities.h"
#include "stereo/methods/solve_parts.h"

enum { SAMPLE = 240, ITERATIONS = 12, TRIAL_ROUNDS = 4 };

/* Least number of lights: with three, each pixel has an exact surface for any intensities. */
enum { FEWEST_LIGHTS = 4 };

/* Share of the loss of equal intensities to which others must reduce it. */
static const double worth_intensities = 0.8;
static const float likely_terminator = 0.1f;
/* Largest error, as a ratio, that highlights, shadows and the terminator cause in Lambert's intensities. */
static const double most_bent = 1.25;
/* Limit for pst_intensities_find's `uniqueness`. Flat reliefs under unequal lights have 1 to 11 and errors of 3 to 14
 * degrees; reliefs with errors of half a degree, rendered objects and real ones have 24 and more
 * (docs/notes/unknown_lights.md). */
static const double unique_enough = 12;
/* Least share of a channel for a pixel to be informative about it. */
static const float least_colour = 0.1f;

/* Work on the sample under changing intensities. */
typedef struct semi_job {
    pst_problem problem;
    merlin_light *light; /* the problem's lights */
    pst_field field;
    pst_lobe lobe;
    float *weight, *model, *value, *usable; /* count × padded each */
    float *ratio, *colour;                  /* count each */
    size_t padded;
    double cost, least; /* cost of the last fit, and of the best one */
    double *best;       /* count intensities of the best fit, then Lambert's */
    bool equal;         /* whether the result is equal intensities */
} semi_job;

static void set_intensities(semi_job *job, const double *e)
{
    for (int k = 0; k < job->problem.capture->count; k++)
        for (int ch = 0; ch < 3; ch++)
            job->light[k].intensity[ch] = (float)e[k];
}

/* Computes each light's intensity from the surface: the ratio of observed to expected brightness for most of the pixels
 * that it should light. */
static void from_surface(const semi_job *job, double *e)
{
    int count = job->problem.capture->count;
    for (int k = 0; k < count; k++) {
        size_t lit = 0;
        for (size_t i = 0; i < job->field.count; i++) {
            size_t at = i * job->padded + (size_t)k;
            if (job->usable[at] > 0 && job->model[at] > PST_WELL_LIT * job->field.shading[i].albedo)
                job->ratio[lit++] = job->value[at] * job->light[k].intensity[0] / job->model[at];
        }
        e[k] = pst_intensities_typical(job->ratio, lit);
    }
    pst_intensities_normalize(e, count);
}

static float channel_of(const semi_job *job, size_t i, int light, int channel)
{
    const merlin_capture *c = job->problem.capture;
    return pst_code(&c->picture[light], (size_t)job->field.pixel[i] * (size_t)c->channels + (size_t)channel) / 65535.0f;
}

/* Returns a pixel's brightness in a channel relative to its grey one, over all lights. */
static float colour(const semi_job *job, size_t i, int channel)
{
    float seen = 0, grey = 1e-20f;
    for (int k = 0; k < job->problem.capture->count; k++) {
        size_t at = i * job->padded + (size_t)k;
        seen += job->weight[at] * channel_of(job, i, k, channel);
        grey += job->weight[at] * job->value[at] * job->light[k].intensity[0];
    }
    return seen / grey;
}

/* Computes the lights' intensities in a channel from their grey ones, by the ratio in most pixels relative to their own
 * colour. */
static void find_channel(const semi_job *job, int channel, double *e)
{
    int count = job->problem.capture->count;
    for (size_t i = 0; i < job->field.count; i++)
        job->colour[i] = colour(job, i, channel);
    for (int k = 0; k < count; k++) {
        size_t lit = 0;
        for (size_t i = 0; i < job->field.count; i++) {
            size_t at = i * job->padded + (size_t)k;
            float grey = job->value[at] * job->light[k].intensity[0];
            if (job->usable[at] > 0 && job->colour[i] > least_colour &&
                job->value[at] > PST_WELL_LIT * job->field.shading[i].albedo)
                job->ratio[lit++] = channel_of(job, i, k, channel) / (grey * job->colour[i]);
        }
        e[k] = (double)job->light[k].intensity[0] * pst_intensities_about(job->ratio, lit, 1);
    }
    pst_intensities_normalize(e, count);
}

/* Makes the lights' intensities coloured. e: 3 × count to work with. */
static void find_colours(semi_job *job, double *e)
{
    int count = job->problem.capture->count;
    for (int ch = 0; ch < 3; ch++)
        find_channel(job, ch, e + ch * count);
    for (int i = 0; i < 3 * count; i++)
        job->light[i % count].intensity[i / count] = (float)e[i];
}

/* Fits the surface to the intensities. */
static status fit_surface(semi_job *job, bool choose, const double *e)
{
    set_intensities(job, e);
    status s = choose ? pst_lobe_choose(&job->field, &job->lobe) : OK;
    if (s == OK) s = pst_field_fit(&job->field, &job->cost);
    if (s == OK) s = pst_field_model(&job->field, job->weight, job->model);
    if (s != OK) return s;
    pst_gather(&job->problem, job->field.pixel, job->field.count, job->value, job->usable, job->padded);
    if (job->cost >= job->least) return OK;
    job->least = job->cost;
    memcpy(job->best, e, (size_t)job->problem.capture->count * sizeof *e);
    return OK;
}

/* Computes the intensities from the surface, limited to a range around Lambert's: pixels of a light whose intensity is
 * too high would become shadows, which cost little, so that it would grow without limit. */
static void correct(semi_job *job, double *e)
{
    const double *lambert = job->best + job->problem.capture->count;
    from_surface(job, e);
    for (int k = 0; k < job->problem.capture->count; k++)
        e[k] = fmin(fmax(e[k], lambert[k] / most_bent), lambert[k] * most_bent);
}

/* Updates surface and intensities in turn, from e; the lobe is chosen again as they improve. The result of least cost
 * is kept, since the two steps do not minimize the same loss. */
static status improve(semi_job *job, bool choose, int rounds, double *e)
{
    status s = OK;
    for (int k = 0; s == OK && k < rounds; k++) {
        s = fit_surface(job, choose && k % 3 == 0, e);
        if (s == OK) correct(job, e);
    }
    return s;
}

/* Tries a terminator together with the intensities, which otherwise absorb it. */
static status try_terminator(semi_job *job, double *e)
{
    if (job->problem.capture->count < PST_MANY_LIGHTS) return OK;
    status s = fit_surface(job, true, e);
    if (job->lobe.terminator > 0) return s;
    job->lobe.terminator = likely_terminator;
    return s == OK ? improve(job, false, TRIAL_ROUNDS, e) : s;
}

/* Decides between Lambert's intensities, in e, and equal ones, which most captures have, and which are given up only
 * for a much lower cost. */
static status settle(semi_job *job, int rounds, double *e)
{
    size_t count = (size_t)job->problem.capture->count, bytes = count * sizeof *e;
    double *lambert = job->best + count;
    memcpy(lambert, e, bytes);
    for (size_t k = 0; k < count; k++)
        e[k] = 1;
    status s = fit_surface(job, true, e);
    double cost = job->cost;
    job->least = HUGE_VAL;
    memcpy(e, lambert, bytes);
    if (s == OK) s = improve(job, true, TRIAL_ROUNDS, e);
    memcpy(e, job->best, bytes);
    if (s == OK) s = try_terminator(job, e);
    memcpy(e, job->best, bytes);
    if (s == OK) s = improve(job, true, rounds, e);
    memcpy(e, job->best, bytes);
    job->equal = job->least >= worth_intensities * cost;
    for (size_t k = 0; k < count && job->equal; k++)
        e[k] = 1;
    return s == OK ? fit_surface(job, true, e) : s;
}

static status job_new(const pst_problem *p, merlin_light *light, semi_job *job)
{
    uint32_t *pixel;
    size_t n;
    *job =
        (semi_job){.problem = *p, .light = light, .padded = (size_t)pst_padded(p->capture->count), .least = HUGE_VAL};
    job->problem.light = light;
    status s = pst_field_sample(p, SAMPLE, &pixel, &n);
    if (s != OK) return s;
    job->field = (pst_field){.problem = &job->problem, .pixel = pixel, .count = n, .lobe = &job->lobe};
    job->field.shading = calloc(n, sizeof *job->field.shading);
    job->weight = malloc((4 * job->padded + 2) * n * sizeof *job->weight);
    job->best = calloc(2 * (size_t)p->capture->count, sizeof *job->best);
    if (!job->field.shading || !job->weight || !job->best)
        return fail(MERLIN_NO_MEMORY, "no memory for a sample of %zu pixels", n);
    job->model = job->weight + n * job->padded;
    job->value = job->model + n * job->padded;
    job->usable = job->value + n * job->padded;
    job->ratio = job->usable + n * job->padded;
    job->colour = job->ratio + n;
    return OK;
}

static void job_free(semi_job *job)
{
    free((uint32_t *)job->field.pixel);
    free(job->field.shading);
    free(job->weight);
    free(job->best);
}

/* Finds the intensities and sets them in the surface's lights, which are the problem's. */
static status find_strengths(const pst_problem *p, merlin_surface *out)
{
    int count = p->capture->count;
    semi_job job = {0};
    double uniqueness = 0, *e = calloc(3 * (size_t)count, sizeof *e);
    status s = e ? job_new(p, out->lights, &job) : fail(MERLIN_NO_MEMORY, "no memory for %d lights", count);
    if (s == OK) s = pst_intensities_find(p, SAMPLE, e, &uniqueness);
    if (s == OK) s = settle(&job, p->iterations > 0 ? p->iterations : ITERATIONS, e);
    if (s == OK && !job.equal && p->capture->channels == 3) find_colours(&job, e);
    out->strengths_unsure = s == OK && !job.equal && uniqueness < unique_enough;
    free(e);
    job_free(&job);
    return s;
}

status pst_solve_semi(const pst_problem *p, merlin_surface *out)
{
    size_t count = (size_t)p->capture->count;
    out->lights = malloc(count * sizeof *out->lights);
    if (!out->lights) return fail(MERLIN_NO_MEMORY, "no memory for %zu lights", count);
    memcpy(out->lights, p->light, count * sizeof *out->lights);
    out->strengths_unsure = count < FEWEST_LIGHTS;
    status s = out->strengths_unsure ? OK : find_strengths(p, out);
    pst_problem known = *p;
    known.light = out->lights;
    return s == OK ? pst_solve_robust(&known, out) : s;
}
