/* Near point lights and a perspective camera, alternating (the scheme of Logothetis, Mecca & Cipolla, Semi-calibrated
 * near field photometric stereo, CVPR 2017, with a robust fit for the normals): from a depth map each pixel has its own
 * light vectors, inverse-square attenuation and LED lobes; from these its normal (field_fit.h); from the normals a
 * depth map by integration. The first depth map is a plane that faces the camera.
 *
 * Most rounds are gone through on a small version of the pictures (shrink.h), which knows the depth nearly as well.
 *
 * Normals leave the scale of the depth free. It is the camera's mean distance where that is known; otherwise the lights
 * tell: only at the right distance does what they send agree with the inverse-square law. With few lights the first
 * rounds also find out whether a highlight's lobe is worth fitting (lobe_choice.h). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/field_fit.h"
#include "stereo/integrate.h"
#include "stereo/lobe_choice.h"
#include "stereo/shrink.h"

/* SMALL: pixels that the depth is searched on, up to four times as many; ANEW: rounds whose fits start from nothing,
 * since the depth was far off; ADMISSIONS: rounds until it is good enough to judge a lobe by. */
enum { ITERATIONS = 12, SAMPLE = 192, SMALL = 1500, ANEW = 3, ADMISSIONS = 2, SWEEPS = 2 };

/* Rounds end when no depth moves by more than this share of the distance. */
static const float settled = 1e-4f;

/* What the small depth map weighs against a step between pixels: it holds over about 1/√this pixels. */
static const float small_weight = 1e-3f;

typedef struct near_job {
    const pst_problem *problem;
    pst_surface *out;
    pst_field sample; /* for the scale */
    pst_camera camera;
    pst_lobe lobe;
    pst_shading *shading; /* a pixel */
    float moved;          /* by the last integration: most of all pixels, against the distance */
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

/* The factor on the depth with the least loss among 2 steps + 1 factors a ratio apart around 1. */
static status best_scale(near_job *job, float ratio, int steps, bool anew, float *scale)
{
    double best = HUGE_VAL, cost;
    status s = OK;
    pst_field f = job->sample;
    f.depth = &job->out->depth;
    for (int k = -steps; s == OK && k <= steps; k++) {
        f.scale = powf(ratio, (float)k);
        s = anew ? pst_field_fit(&f, &cost) : pst_field_refine(&f, &cost);
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

static pst_field whole_field(const near_job *job)
{
    const pst_problem *p = job->problem;
    return (pst_field){.problem = p,
                       .pixel = p->pixel,
                       .count = p->pixel_count,
                       .depth = &job->out->depth,
                       .scale = 1,
                       .lobe = &job->lobe,
                       .shading = job->shading};
}

/* anew: from nothing, else from the normals before. */
static status fit_normals(const near_job *job, bool anew)
{
    pst_field f = whole_field(job);
    double cost;
    status s = anew ? pst_field_fit(&f, &cost) : pst_field_refine(&f, &cost);
    /* with few lights a wrong surface costs no more, and would spread */
    if (s == OK && anew && job->problem->capture->count >= PST_MANY_LIGHTS) s = pst_field_spread(&f, SWEEPS);
    for (size_t i = 0; s == OK && i < f.count; i++) {
        vec3 n = pst_facing(f.shading[i].normal);
        memcpy(job->out->normal.data + 3 * (size_t)f.pixel[i], &(float[3]){n.x, n.y, n.z}, 3 * sizeof(float));
    }
    return s;
}

static status admit_lobe(near_job *job)
{
    pst_field f = job->sample;
    f.depth = &job->out->depth;
    f.scale = 1;
    return pst_lobe_admit(&f, &job->lobe);
}

/* The depth map by way of the normals. */
static status integrate(near_job *job, const pst_integration *how)
{
    img depth = {0};
    status s = pst_integrate(&job->out->normal, &job->problem->capture->mask, &job->camera, how, &depth);
    if (s != OK) return s;
    job->moved = change(job->problem, &depth, &job->out->depth, job->camera.mean_distance);
    img_free(&job->out->depth);
    job->out->depth = depth;
    return OK;
}

static status iterate(near_job *job, bool scale_known)
{
    const pst_problem *p = job->problem;
    int iterations = p->iterations > 0 ? p->iterations : ITERATIONS;
    status s = OK;
    float ratio = 1.2f;
    job->moved = 1;
    for (int k = 0; s == OK && k < iterations && job->moved > settled; k++) {
        if (k < ADMISSIONS) s = admit_lobe(job);
        if (s == OK) s = fit_normals(job, k < ANEW);
        if (s == OK) s = integrate(job, &(pst_integration){0});
        if (s != OK || scale_known) continue;
        float scale = 1;
        s = best_scale(job, ratio, 3, k < ANEW, &scale);
        rescale(job, scale);
        job->moved = fmaxf(job->moved, fabsf(scale - 1));
        ratio = 1 + (ratio - 1) * 0.7f;
    }
    return s;
}

/* From a plane at the distance that is known or most likely. */
static status find_depth(near_job *job)
{
    const pst_problem *p = job->problem;
    bool scale_known = job->camera.mean_distance > 0;
    job->camera.perspective = true;
    if (!scale_known) job->camera.mean_distance = fmaxf(light_reach(p->capture), 1e-6f);
    fill_plane(p, job->camera.mean_distance, &job->out->depth);
    float scale = 1;
    status s = scale_known ? OK : best_scale(job, 1.3f, 8, true, &scale);
    rescale(job, scale);
    if (s == OK) s = iterate(job, scale_known);
    /* steps in depth are let in at the end: that integration takes many times as long */
    if (s == OK) s = fit_normals(job, true);
    return s == OK ? integrate(job, &(pst_integration){.preserve_edges = true}) : s;
}

static void job_free(near_job *job)
{
    free(job->shading);
    free(job->sample.shading);
    free((uint32_t *)job->sample.pixel);
}

static status job_new(const pst_problem *p, pst_surface *out, near_job *job)
{
    *job = (near_job){.problem = p,
                      .out = out,
                      .sample = {.problem = p},
                      .camera = p->capture->camera,
                      .lobe = {.masking = 0.28f, .tail = 2, .width = 0.04f, .shadow = PST_SHADOW_COST}};
    uint32_t *pixel;
    status s = img_new(&out->depth, p->capture->width, p->capture->height, 1);
    if (s == OK) s = pst_field_sample(p, SAMPLE, &pixel, &job->sample.count);
    if (s != OK) return s;
    job->sample.pixel = pixel;
    job->sample.lobe = &job->lobe;
    job->sample.shading = calloc(job->sample.count, sizeof *job->shading);
    job->shading = calloc(p->pixel_count, sizeof *job->shading);
    return job->shading && job->sample.shading ? OK : fail(ERROR_MEMORY, "no memory to fit %zu pixels", p->pixel_count);
}

/* The depth map, the distance and the lobe from the small pictures. */
static status find_depth_small(near_job *job, int factor)
{
    const pst_capture *c = job->problem->capture;
    pst_capture small;
    status s = pst_shrink(c, pst_blocks_of(c, factor), job->problem->saturation, &small);
    if (s != OK) return s;
    pst_problem p = *job->problem;
    pst_surface found = {0};
    near_job search = {0};
    p.capture = &small;
    s = pst_list_pixels(&small, &p);
    if (s == OK) s = img_new(&found.normal, small.width, small.height, 3);
    if (s == OK) s = job_new(&p, &found, &search);
    if (s == OK) s = find_depth(&search);
    if (s == OK) pst_enlarge(&found.depth, &small.mask, &c->mask, factor, &job->out->depth);
    job->lobe = search.lobe;
    job->camera.mean_distance = search.camera.mean_distance;
    job->camera.perspective = true;
    job_free(&search);
    pst_surface_free(&found);
    free(p.pixel);
    pst_capture_free(&small);
    return s;
}

/* The small depth map keeps its steps and is filled in with what the small pictures do not show. */
static status fill_in(near_job *job)
{
    img small;
    status s = fit_normals(job, true);
    if (s == OK) s = img_copy(&small, &job->out->depth);
    if (s != OK) return s;
    s = integrate(job, &(pst_integration){.prior = &small, .prior_weight = small_weight});
    img_free(&small);
    return s;
}

static status solve(near_job *job)
{
    int factor = (int)sqrtf((float)job->problem->pixel_count / SMALL);
    status s = factor > 1 ? find_depth_small(job, factor) : find_depth(job);
    if (s == OK && factor > 1) s = fill_in(job);
    if (s == OK) s = fit_normals(job, false);
    pst_field f = whole_field(job);
    return s == OK ? pst_field_store(&f, job->out) : s;
}

status pst_solve_near(const pst_problem *p, pst_surface *out)
{
    near_job job;
    status s = job_new(p, out, &job);
    if (s == OK) s = solve(&job);
    job_free(&job);
    return s;
}
