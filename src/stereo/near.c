/* Near point lights and a perspective camera, alternating (the scheme of Logothetis, Mecca & Cipolla, Semi-calibrated
 * near field photometric stereo, CVPR 2017, with a robust fit for the normals): from a depth map each pixel has its own
 * light vectors, inverse-square attenuation and LED lobes; from these its normal (field_fit.h); from the normals a
 * depth map by integration. The first depth map is a plane that faces the camera.
 *
 * Normals leave the scale of the depth free. It is the camera's mean distance where that is known; otherwise the lights
 * tell: only at the right distance does what they send agree with the inverse-square law. With few lights the first
 * rounds also find out whether a highlight's lobe is worth fitting (lobe_choice.h). */
#include <math.h>
#include <stdlib.h>

#include "stereo/field_fit.h"
#include "stereo/integrate.h"
#include "stereo/lobe_choice.h"

/* ADMISSIONS: rounds until the depth is good enough to judge a lobe by. */
enum { ITERATIONS = 12, SAMPLE = 192, ADMISSIONS = 2 };

/* Rounds end when no depth moves by more than this share of the distance. */
static const float settled = 1e-4f;

typedef struct near_job {
    const pst_problem *problem;
    pst_surface *out;
    pst_field sample; /* for the scale */
    pst_camera camera;
    pst_lobe lobe;
    pst_shading *shading; /* a pixel; the sample's for a while */
} near_job;

static void fill_plane(const pst_problem *p, float distance, img *depth)
{
    for (size_t i = 0; i < p->pixel_count; i++)
        depth->data[p->pixel[i]] = distance;
}

static float light_reach(const pst_capture *c)
{
    float sum = 0;
    for (int k = 0; k < c->count; k++)
        sum += vec3_length(c->light[k].position);
    return sum / (float)c->count;
}

/* The factor on the depth with the least loss among steps factors a ratio apart around centre. */
static status best_scale(near_job *job, float centre, float ratio, int steps, float *scale)
{
    double best = HUGE_VAL, cost;
    status s = OK;
    pst_field f = job->sample;
    f.depth = &job->out->depth;
    for (int k = -steps; s == OK && k <= steps; k++) {
        f.scale = centre * powf(ratio, (float)k);
        s = pst_field_fit(&f, &cost);
        if (s == OK && cost < best) {
            best = cost;
            *scale = f.scale;
        }
    }
    return s;
}

static void rescale(near_job *job, float scale)
{
    img *depth = &job->out->depth;
    for (size_t i = 0; i < job->problem->pixel_count; i++)
        depth->data[job->problem->pixel[i]] *= scale;
    job->camera.mean_distance *= scale;
}

/* Largest change in depth against the distance. */
static float change(const pst_problem *p, const img *a, const img *b, float distance)
{
    float most = 0;
    for (size_t i = 0; i < p->pixel_count; i++)
        most = fmaxf(most, fabsf(a->data[p->pixel[i]] - b->data[p->pixel[i]]));
    return most / distance;
}

static status fit_normals(const near_job *job)
{
    const pst_problem *p = job->problem;
    pst_field f = {.problem = p,
                   .pixel = p->pixel,
                   .count = p->pixel_count,
                   .depth = &job->out->depth,
                   .scale = 1,
                   .lobe = &job->lobe,
                   .shading = job->shading};
    double cost;
    status s = pst_field_fit(&f, &cost);
    return s == OK ? pst_field_store(&f, job->out) : s;
}

static status admit_lobe(near_job *job)
{
    pst_field f = job->sample;
    f.depth = &job->out->depth;
    f.scale = 1;
    return pst_lobe_admit(&f, &job->lobe);
}

/* The depth map by way of the normals; *moved: its largest change. */
static status renew_depth(near_job *job, bool preserve_edges, float *moved)
{
    const pst_integration how = {.preserve_edges = preserve_edges};
    img depth = {0};
    status s = fit_normals(job);
    if (s == OK) s = pst_integrate(&job->out->normal, &job->problem->capture->mask, &job->camera, &how, &depth);
    if (s != OK) return s;
    *moved = change(job->problem, &depth, &job->out->depth, job->camera.mean_distance);
    img_free(&job->out->depth);
    job->out->depth = depth;
    return OK;
}

static status iterate(near_job *job, bool scale_known)
{
    const pst_problem *p = job->problem;
    int iterations = p->iterations > 0 ? p->iterations : ITERATIONS;
    status s = OK;
    float moved = 1, ratio = 1.2f;
    for (int k = 0; s == OK && k < iterations && moved > settled; k++) {
        if (k < ADMISSIONS) s = admit_lobe(job);
        if (s == OK) s = renew_depth(job, false, &moved);
        if (s != OK || scale_known) continue;
        float scale = 1;
        s = best_scale(job, 1, ratio, 3, &scale);
        rescale(job, scale);
        moved = fmaxf(moved, fabsf(scale - 1));
        ratio = 1 + (ratio - 1) * 0.7f;
    }
    /* steps in depth are let in at the end: that integration takes many times as long */
    if (s == OK) s = renew_depth(job, true, &moved);
    return s == OK ? fit_normals(job) : s;
}

/* From a plane at the distance that is known or most likely. */
static status solve(near_job *job)
{
    const pst_problem *p = job->problem;
    bool scale_known = job->camera.mean_distance > 0;
    job->camera.perspective = true;
    if (!scale_known) job->camera.mean_distance = fmaxf(light_reach(p->capture), 1e-6f);
    fill_plane(p, job->camera.mean_distance, &job->out->depth);
    float scale = 1;
    status s = scale_known ? OK : best_scale(job, 1, 1.3f, 8, &scale);
    rescale(job, scale);
    return s == OK ? iterate(job, scale_known) : s;
}

status pst_solve_near(const pst_problem *p, pst_surface *out)
{
    near_job job = {.problem = p,
                    .out = out,
                    .sample = {.problem = p},
                    .camera = p->capture->camera,
                    .lobe = {.masking = 0.28f, .tail = 2, .width = 0.04f, .shadow = PST_SHADOW_COST}};
    job.shading = calloc(p->pixel_count, sizeof *job.shading);
    if (!job.shading) return fail(ERROR_MEMORY, "no memory to fit %zu pixels", p->pixel_count);
    uint32_t *pixel = NULL;
    status s = img_new(&out->depth, p->capture->width, p->capture->height, 1);
    if (s == OK) s = pst_field_sample(p, SAMPLE, &pixel, &job.sample.count);
    if (s == OK) {
        job.sample.pixel = pixel;
        job.sample.lobe = &job.lobe;
        job.sample.shading = job.shading;
        s = solve(&job);
    }
    free(job.shading);
    free(pixel);
    return s;
}
