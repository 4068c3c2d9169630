/* SPDX-License-Identifier: MIT */
/* Two to six pictures under unknown lights of an object that is expected from elsewhere (pst_expected). They leave much
 * open: lights and a coarse surface are those that explain the pictures and differ least from what is expected
 * (bundle.h), and each pixel's normal is fitted to its values with that surface as a prior, by iteratively reweighted
 * least squares. */
#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "stereo/algebra/matrix3.h"
#include "stereo/fit/field_fit.h"
#include "stereo/fit/near_lights.h"
#include "stereo/integrate/integrate.h"
#include "stereo/uncalibrated/uncalibrated_parts.h"

/* Weight of the prior, as so many of each picture's values; width of the loss in the pixel's ordinary value; steps. */
static const float prior_share = 0.1f, width = 0.3f;
enum { STEPS = 6, BLOCK = 64 };
/* Cost of a value from which on there is a warning. Measured: 0.01 to 0.06 of two to six pictures of a cat, an owl and
 * a ball, 0.01 to 0.26 of rendered objects with deep shadows; 0.2 to 0.4 of pictures of two of them, except 0.12 of one
 * each of cat and owl; 0.17 to 0.5 of pictures that moved. */
static const double unexplained = 0.18;
/* Share of the ordinary value below which a picture is in shadow. */
static const float dark = 0.1f;

typedef struct few_job {
    const pst_problem *problem;
    const img *depth, *normal;
    merlin_surface *out;
} few_job;

/* A pixel's values under its lights, as if all were distant and of one power. */
typedef struct few_pixel {
    int count;
    const pst_near_lights *light;
    const float *value, *usable;
} few_pixel;

static vec3 direction(const few_pixel *p, int k)
{
    return vec3_make(p->light->x[k], p->light->y[k], p->light->z[k]);
}

/* Returns the albedo with which a normal explains the values best. */
static float albedo_of(const few_pixel *p, vec3 n)
{
    float product = 0, square = 0;
    for (int k = 0; k < p->count; k++) {
        const float cosine = fmaxf(vec3_dot(n, direction(p, k)), 0);
        product += p->usable[k] * p->value[k] * cosine;
        square += p->usable[k] * cosine * cosine;
    }
    return square > 0 ? product / square : 0;
}

/* Makes a step: albedo times normal that explains the weighted values, and differs little from the prior. */
static vec3 step(const few_pixel *p, vec3 b, vec3 prior, float level)
{
    const float hold = prior_share * (float)p->count;
    float m[6] = {hold, 0, 0, hold, 0, hold};
    vec3 right = vec3_scale(prior, hold);
    for (int k = 0; k < p->count; k++) {
        const vec3 l = direction(p, k);
        const float shading = vec3_dot(b, l), r = (p->value[k] - fmaxf(shading, 0)) / (width * level);
        if (!(p->usable[k] > 0) || (shading < 0 && p->value[k] < dark * level)) continue;
        const float w = 1 / ((1 + r * r) * (1 + r * r));
        pst_add_outer3(m, vec3_scale(l, w), l);
        right = vec3_fma(right, w * p->value[k], l);
    }
    return pst_solve3(m, right);
}

static void fit_pixel(const few_job *job, size_t at, const float *value, const float *usable, const pst_near_lights *l)
{
    const few_pixel p = {job->problem->capture->count, l, value, usable};
    const vec3 n = vec3_of(job->normal->data + 3 * at);
    const float albedo = albedo_of(&p, n);
    const vec3 prior = vec3_scale(n, albedo);
    vec3 b = prior;
    for (int i = 0; i < STEPS && albedo > 0; i++)
        b = step(&p, b, prior, albedo);
    vec3_put(albedo > 0 ? pst_facing(b) : n, job->out->normal.data + 3 * at);
    for (int ch = 0; ch < job->out->albedo.channels; ch++)
        job->out->albedo.data[at * (size_t)job->out->albedo.channels + (size_t)ch] = vec3_length(b);
}

static void fit_block(void *context, size_t block)
{
    const few_job *job = context;
    const pst_problem *p = job->problem;
    const merlin_capture *c = p->capture;
    const size_t stride = (size_t)pst_padded(c->count), first = block * BLOCK;
    const size_t count = p->pixel_count - first < BLOCK ? p->pixel_count - first : BLOCK;
    float value[BLOCK * PST_LANES], usable[BLOCK * PST_LANES];
    pst_gather(p, p->pixel + first, count, value, usable, stride);
    for (size_t i = 0; i < count; i++) {
        const size_t at = p->pixel[first + i];
        const vec3 ray = pst_ray(&c->camera, (int)(at % (size_t)c->width), (int)(at / (size_t)c->width));
        pst_near_lights lights;
        pst_near_lights_at(p, vec3_scale(ray, job->depth->data[at]), &lights);
        pst_near_lights_divide(&lights, (int)stride, value + i * stride, usable + i * stride);
        fit_pixel(job, at, value + i * stride, usable + i * stride, &lights);
    }
}

status pst_solve_few(const pst_problem *p, bool camera_known, merlin_surface *out)
{
    pst_near_found lights;
    status s = camera_known ? pst_find_near_lights(p, &p->capture->camera, &lights)
                            : pst_find_lights_afar(p, &p->capture->camera, &lights);
    pst_problem found = *p;
    found.light = lights.light;
    few_job job = {&found, &lights.depth, &lights.bent, out};
    if (s == OK) parallel_for((p->pixel_count + BLOCK - 1) / BLOCK, fit_block, &job);
    const pst_integration how = {.prior = &lights.depth, .prior_weight = PST_KEEP_DEPTH};
    if (s == OK) s = pst_integrate(&out->normal, &p->capture->mask, &p->capture->camera, &how, &out->depth);
    img_free(&out->spread); /* that of the pictures would not include the prior's errors, which are larger */
    out->lights = lights.light;
    out->lights_unsure = lights.cost_of_value > unexplained;
    out->strengths_unsure = lights.uneven;
    lights.light = NULL;
    pst_near_found_free(&lights);
    return s;
}
