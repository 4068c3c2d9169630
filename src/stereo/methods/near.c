/* SPDX-License-Identifier: MIT */
/* Photometric stereo with near point lights and a perspective camera by alternation (the scheme of Logothetis, Mecca &
 * Cipolla, Semi-calibrated near field photometric stereo, CVPR 2017, with a robust fit for the normals): a depth map
 * gives each pixel its own light vectors, inverse-square attenuation and LED lobes; these give its normal
 * (field_fit.h); and the normals give a depth map by integration. The first depth map is a plane that faces the camera.
 *
 * Normals do not determine how far behind another a part of the object lies, and integration alone joins parts that
 * only touch in the picture. The lights do: each pixel's fit also yields the distance at which it would agree better
 * with their fall-off (fall_off.h), toward which its depth is weakly pulled, so that all of a part's pixels together
 * place the part.
 *
 * Most rounds use a small version of the pictures (smaller_problem.h), which determines the depth nearly as well.
 *
 * Where a surface is expected, the fits begin with its normals and depth, and find the explanation nearest to it: of
 * few lights many surfaces explain the pictures, and of many lights there is less to search. From ENOUGH lights on the
 * depth that is searched for without it is preferred if it explains the pictures far better.
 *
 * If the camera's mean distance is known, the depth keeps it until parts have found their positions (afterwards
 * remaining errors in dark regions must not move the rest); otherwise the lights determine it, too. With few lights the
 * first rounds also decide whether fitting a highlight's lobe is justified (lobe_choice.h). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/algebra/matrix3.h"
#include "stereo/capture/shrink.h"
#include "stereo/fit/field_fit.h"
#include "stereo/fit/lobe_choice.h"
#include "stereo/fit/smaller_problem.h"
#include "stereo/integrate/integrate.h"
#include "stereo/methods/solve_parts.h"

/* SMALL: number of pixels on which the depth is searched, up to four times as many; ANEW: rounds whose fits have no
 * start, since the depth is far off; ADMISSIONS: rounds until it suffices to decide about a lobe; STEPPED: rounds with
 * steps in depth at the end. */
enum { ITERATIONS = 12, SAMPLE = 192, SMALL = 1500, ANEW = 3, ADMISSIONS = 2, STEPPED = 2, SWEEPS = 2 };

/* ROUNDS: from what is expected; only the last one looks for steps in depth, which takes most of the time. MEDIUM:
 * number of pixels that take part, up to four times as many, as a network's surface has no more. ENOUGH: lights from
 * which on costs tell a wrong surface; far_better: by this factor. */
enum { ROUNDS = 3, MEDIUM = 60000, ENOUGH = 8 };
static const double far_better = 0.7;

/* Rounds end when depths change by less than this share of the distance on average. */
static const float settled = 3e-4f;

/* Assumed error of the normals' slopes relative to a pixel's own estimate of its depth: larger while parts still move,
 * smaller when the surface is to be smooth. Normals have smaller errors, but neighbours' depths have correlated ones.
 * Rendered objects give nearly the same results for slopes from half to twice these. */
static const float searching = 0.3f, placed = 0.1f;

/* Largest change of log depth per pixel and round, and limits of its weight, which is not higher than for an accuracy
 * of one percent. */
static const float most_offset = 0.1f, most_trust = 1e4f, least_trust = 1e-2f;

/* The distance counts as determined if changing it by this factor multiplies the cost by least_factor and adds
 * least_added per pixel, since noise changes it, too. Rings of four lights have 1 to 1.2 and 0.04, three lights
 * nothing; five around a ball 4 and 0.5, fifty around objects of all kinds at least 1.6 and 8 (docs/notes/solvers.md
 * states the errors with a ring). */
static const float elsewhere = 1.25f;
static const double least_factor = 1.3, least_added = 0.1;

typedef struct near_job {
    const pst_problem *problem;
    merlin_surface *out;
    pst_field sample; /* pixels for the scale */
    pinhole camera;
    pst_lobe lobe;
    pst_shading *shading; /* one per pixel */
    float held_at;      /* mean distance while it is fixed: if known, until parts have found their positions; else 0 */
    const watch *watch; /* progress of the integration, if it takes long; else NULL */
    float moved;        /* mean change by the last integration relative to the distance */
} near_job;

static void fill_plane(const pst_problem *p, float distance, img *depth)
{
    for (size_t i = 0; i < p->pixel_count; i++)
        depth->data[p->pixel[i]] = distance;
}

/* Fills in the expected depth or, without one, a plane. */
static void fill_first(near_job *job)
{
    const pst_problem *p = job->problem;
    const img *expected = p->expected ? p->expected->depth : NULL;
    fill_plane(p, job->camera.distance, &job->out->depth);
    for (size_t i = 0; expected && i < p->pixel_count; i++)
        if (expected->data[p->pixel[i]] > 0) job->out->depth.data[p->pixel[i]] = expected->data[p->pixel[i]];
}

/* Computes the cost of the sampled pixels with the depth multiplied by a factor. */
static status cost_at(const near_job *job, float scale, bool anew, double *cost)
{
    pst_field f = job->sample;
    f.depth = &job->out->depth;
    f.scale = scale;
    return anew ? pst_field_fit(&f, cost) : pst_field_refine(&f, cost);
}

/* Finds the factor of the depth with the least cost among 2 steps + 1 factors around 1, a ratio apart. */
static status best_scale(near_job *job, float ratio, int steps, bool anew, float *scale)
{
    double best = HUGE_VAL, cost;
    status s = OK;
    for (int k = -steps; s == OK && k <= steps; k++) {
        float factor = powf(ratio, (float)k);
        s = cost_at(job, factor, anew, &cost);
        if (s == OK && cost < best) {
            best = cost;
            *scale = factor;
        }
    }
    return s;
}

/* Finds out whether other distances explain the pictures equally well, so that the distance is unreliable. */
static status check_distance(const near_job *job, bool *unsure)
{
    double here, nearer, further;
    status s = cost_at(job, 1, true, &here);
    if (s == OK) s = cost_at(job, 1 / elsewhere, true, &nearer);
    if (s == OK) s = cost_at(job, elsewhere, true, &further);
    if (s == OK) *unsure = fmin(nearer, further) < least_factor * here + least_added * (double)job->sample.count;
    return s;
}

static void rescale(near_job *job, float scale)
{
    img *depth = &job->out->depth;
    for (size_t i = 0; i < job->problem->pixel_count; i++)
        depth->data[job->problem->pixel[i]] *= scale;
    job->camera.distance *= scale;
}

static double sum_depth(const near_job *job)
{
    const pst_problem *p = job->problem;
    double sum = 0;
    for (size_t i = 0; i < p->pixel_count; i++)
        sum += (double)job->out->depth.data[p->pixel[i]];
    return sum;
}

static void keep_distance(near_job *job)
{
    rescale(job, job->held_at * (float)job->problem->pixel_count / (float)sum_depth(job));
    job->camera.distance = job->held_at;
}

/* Returns the mean change in depth relative to the distance. */
static float change(const pst_problem *p, const img *a, const img *b, float distance)
{
    double sum = 0;
    for (size_t i = 0; i < p->pixel_count; i++)
        sum += fabs((double)(a->data[p->pixel[i]] - b->data[p->pixel[i]]));
    return (float)(sum / (double)p->pixel_count) / distance;
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

/* Fits normals. anew: without a start, else from the previous normals. */
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

/* Integrates the normals to the depth map. */
static status integrate(near_job *job, const pst_integration *how)
{
    img depth = {0};
    status s = pst_integrate(&job->out->normal, &job->problem->capture->mask, &job->camera, how, &depth);
    if (s != OK) return s;
    img before = job->out->depth;
    job->out->depth = depth;
    if (job->held_at > 0) keep_distance(job);
    job->moved = change(job->problem, &job->out->depth, &before, job->camera.distance);
    img_free(&before);
    return OK;
}

/* Computes the depth by each pixel's own fit, and its weight. */
static status place_pixels(near_job *job, float slope, img *place, img *trust)
{
    pst_field f = whole_field(job);
    pst_fall_off *found = malloc(f.count * sizeof *found);
    status s = found ? OK : fail(MERLIN_NO_MEMORY, "no memory to place %zu pixels", f.count);
    if (s == OK) s = img_copy(place, f.depth);
    if (s == OK) s = img_copy(trust, f.depth);
    if (s == OK) s = pst_field_fall_off(&f, found);
    float unit = slope / job->camera.focal;
    for (size_t i = 0; s == OK && i < f.count; i++) {
        float offset = fmaxf(fminf(found[i].offset, most_offset), -most_offset);
        place->data[f.pixel[i]] *= expf(offset);
        trust->data[f.pixel[i]] = unit * unit * fmaxf(fminf(found[i].trust, most_trust), least_trust);
    }
    free(found);
    return s;
}

/* Integrates the normals and the pixels' own depths to the depth map. */
static status place(near_job *job, float slope, bool preserve_edges)
{
    img place = {0}, trust = {0};
    status s = place_pixels(job, slope, &place, &trust);
    pst_integration how = {.prior = &place,
                           .prior_weight = 1,
                           .trust = &trust,
                           .preserve_edges = preserve_edges,
                           .from_prior = preserve_edges,
                           .watch = job->watch};
    if (s == OK) s = integrate(job, &how);
    img_free(&place);
    img_free(&trust);
    return s;
}

static status iterate(near_job *job)
{
    const pst_problem *p = job->problem;
    int iterations = p->iterations > 0 ? p->iterations : ITERATIONS;
    status s = OK;
    float ratio = 1.2f;
    job->moved = 1;
    for (int k = 0; s == OK && k < iterations && job->moved > settled; k++) {
        if (k < ADMISSIONS) s = admit_lobe(job);
        if (s == OK) s = fit_normals(job, k < ANEW);
        if (s == OK) s = k == 0 ? integrate(job, &(pst_integration){0}) : place(job, searching, false);
        if (s != OK || job->held_at > 0) continue;
        float scale = 1;
        s = best_scale(job, ratio, 3, k < ANEW, &scale);
        rescale(job, scale);
        job->moved = fmaxf(job->moved, fabsf(scale - 1));
        ratio = 1 + (ratio - 1) * 0.7f;
    }
    return s;
}

/* Finds the depth, starting from a plane at the known or most likely distance. */
static status find_depth(near_job *job)
{
    const pst_problem *p = job->problem;
    float distance = p->capture->camera.distance;
    job->held_at = distance;
    job->camera.distance = distance > 0 ? distance : pst_lights_reach(p->capture);
    fill_plane(p, job->camera.distance, &job->out->depth);
    float scale = 1;
    status s = distance > 0 ? OK : best_scale(job, 1.3f, 8, true, &scale);
    rescale(job, scale);
    if (s == OK) s = iterate(job);
    bool unsure = false;
    if (s == OK) s = check_distance(job, &unsure);
    job->out->distance_unsure = unsure && !(distance > 0);
    if (!unsure) job->held_at = 0;
    /* steps in depth are allowed once parts have found their positions */
    for (int k = 0; s == OK && k < STEPPED; k++) {
        s = fit_normals(job, k == 0);
        if (s == OK) s = place(job, placed, true);
    }
    return s;
}

static void job_free(near_job *job)
{
    free(job->shading);
    free(job->sample.shading);
    free((uint32_t *)job->sample.pixel);
}

static status job_new(const pst_problem *p, merlin_surface *out, near_job *job)
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
    return job->shading && job->sample.shading ? OK
                                               : fail(MERLIN_NO_MEMORY, "no memory to fit %zu pixels", p->pixel_count);
}

/* Finds the depth map, the distance and the lobe on the small pictures, in one of the ways, and enlarges the map. */
static status find_small(near_job *job, const smaller_problem *small, status (*find)(near_job *job))
{
    const merlin_capture *c = &small->capture;
    merlin_surface found = {0};
    near_job search = {0};
    status s = img_new(&found.normal, c->width, c->height, 3);
    if (s == OK) s = job_new(&small->problem, &found, &search);
    if (s == OK) s = find(&search);
    if (s == OK) pst_enlarge(&found.depth, &c->mask, &job->problem->capture->mask, small->factor, &job->out->depth);
    job->lobe = search.lobe;
    job->held_at = search.held_at;
    job->out->distance_unsure = found.distance_unsure;
    job->camera.distance = search.camera.distance;
    job_free(&search);
    merlin_surface_free(&found);
    return s;
}

/* Finds the pixels of the enlarged map's steps. */
static status fill_in(near_job *job)
{
    job->watch = job->problem->effort ? job->problem->effort->watch : NULL;
    status s = fit_normals(job, true);
    return s == OK ? place(job, placed, true) : s;
}

/* ---- from what is expected ---- */

/* Finds depth and normals from the expected ones. */
static status find_from_expected(near_job *job)
{
    const pst_problem *p = job->problem;
    const float distance = p->capture->camera.distance;
    const pst_field f = whole_field(job);
    bool unsure = false;
    fill_first(job);
    job->held_at = distance;
    job->camera.distance = distance > 0 ? distance : (float)(sum_depth(job) / (double)p->pixel_count);
    status s = pst_field_given(&f, p->expected->normal);
    if (s == OK && !(distance > 0)) s = check_distance(job, &unsure);
    job->out->distance_unsure = unsure;
    for (int k = 1; s == OK && k <= ROUNDS; k++) {
        s = fit_normals(job, false);
        if (s == OK) s = place(job, placed, k == ROUNDS);
    }
    return s;
}

/* Computes what the depth that is found one way costs, on the small pictures. */
static status cost_of(const smaller_problem *small, status (*find)(near_job *job), double *cost)
{
    merlin_surface found = {0};
    near_job job = {0};
    status s = img_new(&found.normal, small->problem.capture->width, small->problem.capture->height, 3);
    if (s == OK) s = job_new(&small->problem, &found, &job);
    const pst_lobe usual = job.lobe;
    if (s == OK) s = find(&job);
    job.lobe = usual;
    if (s == OK) s = cost_at(&job, 1, true, cost);
    job_free(&job);
    merlin_surface_free(&found);
    return s;
}

/* Tells whether to begin with what is expected, by who knows the lights, too. */
static status prefer_expected(const smaller_problem *small, bool *expected)
{
    const pst_expected *e = small->problem.expected;
    double with, without;
    *expected = e && e->depth && !e->light;
    if (!*expected || small->problem.capture->count < ENOUGH) return OK;
    status s = cost_of(small, find_from_expected, &with);
    if (s == OK) s = cost_of(small, find_depth, &without);
    if (s == OK) *expected = without > far_better * with;
    return s;
}

/* Fits all pixels under the depth that fewer have found, beginning with the expected normals again. */
static status fill_in_expected(near_job *job)
{
    const pst_expected *e = job->problem->expected;
    const pst_field f = whole_field(job);
    status s = pst_field_given(&f, e->normal);
    if (s == OK) s = fit_normals(job, false);
    return s == OK && !e->normals_alone ? place(job, placed, true) : s;
}

static status solve_expected(near_job *job)
{
    smaller_problem medium;
    job->watch = job->problem->effort ? job->problem->effort->watch : NULL;
    status s = smaller_problem_new(job->problem, MEDIUM, &medium);
    if (s == OK) s = medium.factor > 1 ? find_small(job, &medium, find_from_expected) : find_from_expected(job);
    if (s == OK && medium.factor > 1) s = fill_in_expected(job);
    if (s == OK) s = fit_normals(job, false);
    smaller_problem_free(&medium);
    const pst_field f = whole_field(job);
    return s == OK ? pst_field_store(&f, job->out) : s;
}

static status solve_searching(near_job *job, const smaller_problem *small)
{
    status s = small->factor > 1 ? find_small(job, small, find_depth) : find_depth(job);
    if (s == OK && small->factor > 1) s = fill_in(job);
    if (s == OK) s = fit_normals(job, false);
    pst_field f = whole_field(job);
    if (s == OK) s = pst_field_replace_outliers(&f, SWEEPS);
    return s == OK ? pst_field_store(&f, job->out) : s;
}

static status solve(near_job *job)
{
    smaller_problem small;
    bool expected = false;
    status s = smaller_problem_new(job->problem, SMALL, &small);
    if (s == OK) s = prefer_expected(&small, &expected);
    job->out->by_network = expected;
    if (s == OK) s = expected ? solve_expected(job) : solve_searching(job, &small);
    smaller_problem_free(&small);
    return s;
}

status pst_near_distance(const pst_problem *p, float about, float *distance)
{
    static const float ratios[] = {1.3f, 1.08f, 1.02f};
    smaller_problem small;
    merlin_surface surface = {0};
    near_job job = {0};
    status s = smaller_problem_new(p, SMALL, &small);
    if (s == OK) s = job_new(&small.problem, &surface, &job);
    job.camera.distance = about > 0 ? about : pst_lights_reach(p->capture);
    if (s == OK) fill_first(&job);
    for (int i = about > 0 ? 1 : 0; s == OK && i < 3; i++) {
        float scale = 1;
        s = best_scale(&job, ratios[i], i ? 4 : 8, true, &scale);
        rescale(&job, scale);
    }
    *distance = job.camera.distance;
    job_free(&job);
    merlin_surface_free(&surface);
    smaller_problem_free(&small);
    return s;
}

status pst_solve_near(const pst_problem *p, merlin_surface *out)
{
    near_job job;
    status s = job_new(p, out, &job);
    if (s == OK) s = solve(&job);
    job_free(&job);
    return s;
}
