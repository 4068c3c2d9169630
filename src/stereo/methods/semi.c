/* SPDX-License-Identifier: MIT */
/* Light directions known, intensities not (D. Cho, Y. Matsushita, Y.-W. Tai, I. S. Kweon, Semi-calibrated photometric
 * stereo, ECCV 2016 and PAMI 2018).
 *
 * Intensities by Lambert's law (intensities.h) and equal ones are two starts, from which intensities and a sample's
 * surface, its highlights included (lobe_fit.h), alternate. What explains the sample best counts. The mean intensity is
 * 1. On a surface whose normals hardly differ, intensities and albedo explain each other: equal ones are kept unless
 * others explain the pictures much better. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/fit/lobe_choice.h"
#include "stereo/methods/intensities.h"
#include "stereo/methods/solve_parts.h"

enum { SAMPLE = 240, ITERATIONS = 12, TRIAL_ROUNDS = 4 };

/* With three every strength is right: each pixel has a surface for it. */
enum { FEWEST_LIGHTS = 4 };

/* Of the loss of equal intensities: what others must bring it down to. */
static const double worth_intensities = 0.8;
static const float likely_terminator = 0.1f;
/* How far highlights, shadows and the terminator may have taken Lambert's intensities, as a ratio. */
static const double most_bent = 1.25;
/* Of pst_intensities_find. Flat reliefs under unequal lights are told to 1 to 11 and come out 3 to 14 degrees off; ones
 * half a degree off, rendered objects and real ones are told to 24 and more (docs/notes/unknown_lights.md). */
static const double well_told = 12;
/* Pixels of less of a channel say little of it. */
static const float least_colour = 0.1f;

/* The sample under intensities that change. */
typedef struct semi_job {
    pst_problem problem;
    merlin_light *light; /* the problem's */
    pst_field field;
    pst_lobe lobe;
    float *weight, *model, *value, *usable; /* count × padded */
    float *ratio, *colour;                  /* count */
    size_t padded;
    double cost, least; /* of the last look, of the best */
    double *best;       /* count: its intensities; as many more: Lambert's */
    bool equal;         /* what was found */
} semi_job;

static void set_intensities(semi_job *job, const double *e)
{
    for (int k = 0; k < job->problem.capture->count; k++)
        for (int ch = 0; ch < 3; ch++)
            job->light[k].intensity[ch] = (float)e[k];
}

/* Each light's intensity given the surface: what most of the pixels that it should light have in proportion. */
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
    return c->picture[light][(size_t)job->field.pixel[i] * (size_t)c->channels + (size_t)channel] / 65535.0f;
}

/* A pixel's brightness in a channel against its grey one, over all lights. */
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

/* The lights' intensities in a channel from their grey ones: what most pixels have of it beside their own colour. */
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

/* The lights' intensities become coloured. e: 3 × count to work with. */
static void find_colours(semi_job *job, double *e)
{
    int count = job->problem.capture->count;
    for (int ch = 0; ch < 3; ch++)
        find_channel(job, ch, e + ch * count);
    for (int i = 0; i < 3 * count; i++)
        job->light[i % count].intensity[i / count] = (float)e[i];
}

/* The surface from the intensities. */
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

/* The intensities from the surface, not far from Lambert's: a light that is made too strong turns what it lights into
 * shadows, which cost little, and would grow without end. */
static void correct(semi_job *job, double *e)
{
    const double *lambert = job->best + job->problem.capture->count;
    from_surface(job, e);
    for (int k = 0; k < job->problem.capture->count; k++)
        e[k] = fmin(fmax(e[k], lambert[k] / most_bent), lambert[k] * most_bent);
}

/* Surface and intensities in turn, from e; the lobe is chosen anew as they come right. What costs least is kept, since
 * nothing makes the two agree on one loss. */
static status improve(semi_job *job, bool choose, int rounds, double *e)
{
    status s = OK;
    for (int k = 0; s == OK && k < rounds; k++) {
        s = fit_surface(job, choose && k % 3 == 0, e);
        if (s == OK) correct(job, e);
    }
    return s;
}

/* A terminator that is left out goes into the intensities, and no longer shows: it is tried together with them. */
static status try_terminator(semi_job *job, double *e)
{
    if (job->problem.capture->count < PST_MANY_LIGHTS) return OK;
    status s = fit_surface(job, true, e);
    if (job->lobe.terminator > 0) return s;
    job->lobe.terminator = likely_terminator;
    return s == OK ? improve(job, false, TRIAL_ROUNDS, e) : s;
}

/* From Lambert's intensities, in e. Equal ones are what most captures have: they are given up only for what costs much
 * less. */
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

/* Into the surface's lights, which are the problem's. */
static status find_strengths(const pst_problem *p, merlin_surface *out)
{
    int count = p->capture->count;
    semi_job job = {0};
    double told = 0, *e = calloc(3 * (size_t)count, sizeof *e);
    status s = e ? job_new(p, out->lights, &job) : fail(MERLIN_NO_MEMORY, "no memory for %d lights", count);
    if (s == OK) s = pst_intensities_find(p, SAMPLE, e, &told);
    if (s == OK) s = settle(&job, p->iterations > 0 ? p->iterations : ITERATIONS, e);
    if (s == OK && !job.equal && p->capture->channels == 3) find_colours(&job, e);
    out->strengths_unsure = s == OK && !job.equal && told < well_told;
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
