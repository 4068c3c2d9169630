/* SPDX-License-Identifier: MIT */
#include "stereo/fit/field_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/inline.h"
#include "base/memory.h"
#include "base/number.h"
#include "base/parallel.h"
#include "stereo/algebra/matrix3.h"
#include "stereo/fit/field_job.h"
#include "stereo/fit/near_lights.h"
#include "stereo/fit/normal_spread.h"
#include "stereo/fit/pixel_fit.h"

/* Number of pixels that are gathered together, so that a picture's cache lines serve all of them. */
enum { BLOCK = 32 };

typedef struct run_start {
    bool valid;
    float cost;
} run_start;

typedef struct gathered {
    float value[BLOCK * PST_MAX_LIGHTS], usable[BLOCK * PST_MAX_LIGHTS]; /* pst_padded(pictures) per pixel */
} gathered;

/* Gathers a picture's values; channels is a constant in each call, so that the loop is vectorized. */
ALWAYS_INLINE void gather_picture(const pst_problem *p, int k, const uint32_t *pixel, size_t count, int channels,
                                  float *restrict value, float *restrict usable, size_t stride)
{
    const pst_plane *picture = &p->capture->picture[k];
    const float high = p->saturation * 65535;
    float share[3];
    for (int ch = 0; ch < channels; ch++)
        share[ch] = 1 / p->light[k].intensity[ch] / (65535 * (float)channels);
    for (size_t j = 0; j < count; j++) {
        const size_t at = (size_t)pixel[j] * (size_t)channels;
        float sum = 0, top = 0;
        for (int ch = 0; ch < channels; ch++) {
            float v = pst_code(picture, at + (size_t)ch);
            sum += v * share[ch];
            top = v > top ? v : top;
        }
        value[j * stride] = sum;
        usable[j * stride] = top < high ? 1 : 0;
    }
}

void pst_gather(const pst_problem *p, const uint32_t *pixel, size_t count, float *value, float *usable, size_t stride)
{
    const merlin_capture *c = p->capture;
    for (int k = 0; k < c->count; k++) {
        if (c->channels == 1)
            gather_picture(p, k, pixel, count, 1, value + k, usable + k, stride);
        else
            gather_picture(p, k, pixel, count, 3, value + k, usable + k, stride);
    }
    for (size_t j = 0; j < count; j++)
        for (size_t k = (size_t)c->count; k < (size_t)pst_padded(c->count); k++)
            value[j * stride + k] = usable[j * stride + k] = 0;
}

static const pst_lobe *lobe_of(const pst_field *f, const pst_shading *q)
{
    return q->second ? f->second : f->lobe;
}

/* Stores the albedo of each channel by the same weights, the residual and the spread. power NULL: distant lights. */
static void store_pixel(const pst_field_job *job, size_t at, const pst_lobe_data *d, const pst_shading *q,
                        const float *power)
{
    const pst_problem *p = job->field->problem;
    const merlin_capture *c = p->capture;
    const pst_observations *o = &d->seen;
    merlin_surface *out = job->out;
    float w[PST_MAX_LIGHTS], model[PST_MAX_LIGHTS];
    const pst_lobe *kind = lobe_of(job->field, q);
    pst_lobe_weigh(d, kind, q, w, model);
    vec3 n = pst_facing(q->normal);
    float albedo[3] = {0}, energy = 0, fit = 0, residual = 0;
    for (int k = 0; k < c->count; k++) {
        float cosine = fmaxf(n.x * o->x[k] + n.y * o->y[k] + n.z * o->z[k] - kind->terminator, 0);
        const size_t first = at * (size_t)c->channels;
        float wc = w[k] * cosine, r = o->value[k] - model[k], lobe = model[k] - q->albedo * cosine;
        energy += wc * cosine;
        for (int ch = 0; ch < c->channels && wc > 0; ch++)
            albedo[ch] += wc * ((float)pst_code(&c->picture[k], first + (size_t)ch) /
                                    (65535 * p->light[k].intensity[ch] * (power ? power[k] : 1)) -
                                lobe);
        residual += w[k] * r * r;
        fit += w[k] * model[k] * model[k];
    }
    for (int ch = 0; ch < c->channels; ch++)
        albedo[ch] = energy > 1e-12f ? fmaxf(albedo[ch] / energy, 0) : 0;
    memcpy(out->normal.data + 3 * at, &(float[3]){n.x, n.y, n.z}, 3 * sizeof(float));
    memcpy(out->albedo.data + at * (size_t)c->channels, albedo, (size_t)c->channels * sizeof(float));
    out->residual.data[at] = fit > 0 ? sqrtf(residual / fit) : 0;
    out->spread.data[at] = pst_normal_spread(o, w, model, n, q->albedo);
}

/* Fits a pixel starting from the previous one, which is usually adjacent: its result is tried first, and accepted if it
 * costs no more than at the start of a run of pixels. Not with few lights, where a wrong surface costs no more and
 * would be copied along the row. */
static pst_shading fit_after(const pst_field_job *job, size_t i, const pst_lobe_data *d, run_start *begun)
{
    const pst_field *f = job->field;
    if (begun->valid && f->problem->capture->count >= PST_MANY_LIGHTS) {
        pst_shading next = pst_lobe_refine(d, f->lobe, &f->shading[i - 1], HUGE_VALF);
        if (next.cost < begun->cost + PST_FAR_LESS) return next;
    }
    pst_shading found = pst_lobe_fit(d, f->lobe);
    *begun = (run_start){true, found.cost};
    return found;
}

static void try_second(const pst_field *f, size_t i, const pst_lobe_data *d)
{
    pst_shading start = pst_lobe_translate(f->lobe, f->second, &f->shading[i]);
    start.second = true;
    float limit = pst_far_below(f->shading[i].cost);
    pst_shading found = pst_lobe_refine(d, f->second, &start, limit);
    if (found.cost < limit) f->shading[i] = found;
}

static void try_neighbours(const pst_field_job *job, size_t i, const pst_lobe_data *d)
{
    const pst_field *f = job->field;
    const pst_shading *start[4];
    pst_shading *next = &job->next[i - job->first];
    int starts = pst_better_neighbours(&job->around, i, start);
    for (int k = 0; k < starts; k++) {
        pst_shading trial = pst_lobe_refine(d, lobe_of(f, start[k]), start[k], next->cost);
        if (trial.cost < next->cost) *next = trial;
    }
}

/* Replaces a pixel's result by its neighbours'. Detail of one pixel's size costs much less than the neighbours'
 * surface, and stays. */
static void replace_outlier(const pst_field_job *job, size_t i, const pst_lobe_data *d)
{
    const pst_shading *own = &job->field->shading[i];
    pst_majority m;
    if (!pst_majority_against(&job->around, i, &m)) return;
    pst_shading trial = pst_lobe_refine(d, lobe_of(job->field, m.member), m.member, own->cost + job->contradiction);
    float less_strange = pst_strangeness(&m, own->normal) - pst_strangeness(&m, trial.normal);
    if (trial.cost < own->cost + job->contradiction * less_strange) job->next[i - job->first] = trial;
}

/* Returns the median of the albedos by single observations, of those whose light does not graze the surface. */
static float albedo_of(const pst_observations *o, vec3 n)
{
    static const float GRAZING = 0.1f;
    float albedo[PST_MAX_LIGHTS];
    size_t count = 0;
    for (int k = 0; k < o->padded; k++) {
        const float cosine = n.x * o->x[k] + n.y * o->y[k] + n.z * o->z[k];
        if (o->usable[k] > 0 && cosine > GRAZING) albedo[count++] = o->value[k] / cosine;
    }
    if (count == 0) return 0;
    qsort(albedo, count, sizeof *albedo, number_ascending);
    return albedo[count / 2];
}

/* Fits the lobe, and returns the present cost; power NULL: distant lights. */
static float fit_lobe(const pst_field_job *job, size_t i, const pst_lobe_data *d, const float *power, run_start *begun)
{
    const pst_field *f = job->field;
    size_t at = i * (size_t)d->seen.padded;
    pst_shading *own = &f->shading[i];
    switch (job->task) {
    case PST_FIT:
        *own = fit_after(job, i, d, begun);
        break;
    case PST_REFINE:
        *own = pst_lobe_refine(d, lobe_of(f, own), own, HUGE_VALF);
        break;
    case PST_SEARCH:
        *own = pst_lobe_search(d, f->lobe, own);
        break;
    case PST_SECOND:
        try_second(f, i, d);
        break;
    case PST_SPREAD:
        try_neighbours(job, i, d);
        break;
    case PST_OUTLIERS:
        replace_outlier(job, i, d);
        break;
    case PST_ALBEDO:
        *own = (pst_shading){.normal = own->normal, .albedo = albedo_of(&d->seen, own->normal)};
        break;
    case PST_MODEL:
        pst_lobe_weigh(d, lobe_of(f, own), own, job->weight + at, job->model + at);
        break;
    default:
        store_pixel(job, f->pixel[i], d, own, power);
    }
    return own->cost;
}

/* Computes near lights, or a near camera's direction, for a pixel's position. Returns the direction to the camera. */
static vec3 observe_from(const pst_field *f, size_t at, pst_near_lights *lights, float *value, float *usable)
{
    const merlin_capture *c = f->problem->capture;
    int x = (int)(at % (size_t)c->width), y = (int)(at / (size_t)c->width), padded = pst_padded(c->count);
    if (f->depth) {
        vec3 ray = pst_ray(&c->camera, x, y);
        pst_near_lights_at(f->problem, vec3_scale(ray, f->scale * f->depth->data[at]), lights);
        pst_near_lights_divide(lights, padded, value, usable);
        return vec3_normalize(vec3_scale(ray, -1));
    }
    if (!f->lobe || f->lobe->focal <= 0) return vec3_make(0, 0, 1);
    return vec3_normalize(vec3_make((0.5f * (float)c->width - 0.5f - (float)x) / f->lobe->focal,
                                    ((float)y + 0.5f - 0.5f * (float)c->height) / f->lobe->focal, 1));
}

static pst_fall_off fall_off(const pst_field *f, size_t i, const pst_lobe_data *d, const pst_near_lights *lights,
                             vec3 view)
{
    const pst_lobe *kind = lobe_of(f, &f->shading[i]);
    int padded = d->seen.padded, width = f->problem->capture->width;
    size_t at = f->pixel[i];
    vec3 ray = pst_ray(&f->problem->capture->camera, (int)(at % (size_t)width), (int)(at / (size_t)width));
    pst_near_lights behind;
    pst_lobe_data deeper;
    float value[PST_MAX_LIGHTS];
    pst_near_lights_at(f->problem, vec3_scale(ray, f->scale * f->depth->data[at] * expf(PST_DEEPER)), &behind);
    for (int k = 0; k < padded; k++)
        value[k] = behind.power[k] > 0 ? d->seen.value[k] * lights->power[k] / behind.power[k] : 0;
    pst_observations o = {padded, behind.x, behind.y, behind.z, value, d->seen.usable, 0};
    pst_lobe_prepare(&o, view, kind->shadow, &deeper);
    return pst_fall_off_of(d, &deeper, kind, &f->shading[i]);
}

/* Effort of a fit without a start, in units of fits that start from a neighbour. */
enum { FIT_EFFORT = 4 };

/* Tells whether the task has anything to do at a pixel. */
static bool concerns(const pst_field_job *job, size_t i)
{
    const pst_shading *start[4];
    pst_majority m;
    if (job->task == PST_SEARCH) return job->field->shading[i].cost > job->limit;
    if (job->task == PST_OUTLIERS) return pst_majority_against(&job->around, i, &m);
    return job->task != PST_SPREAD || pst_better_neighbours(&job->around, i, start) > 0;
}

/* Returns the cost. */
static float fit_pixel(const pst_field_job *job, size_t i, float *value, float *usable, run_start *begun)
{
    const pst_field *f = job->field;
    pst_near_lights lights;
    vec3 view = observe_from(f, f->pixel[i], &lights, value, usable);
    pst_observations o = {pst_padded(f->problem->capture->count), job->x, job->y, job->z, value, usable, 0};
    if (f->depth) {
        o.x = lights.x;
        o.y = lights.y;
        o.z = lights.z;
    }
    if (!f->lobe) {
        float weight[PST_MAX_LIGHTS];
        pst_pixel p = pst_pixel_fit(&o, weight);
        if (f->b) f->b[i] = p.b;
        return p.cost;
    }
    if (job->task == PST_PREDICT) return pst_lobe_predict(&o, view, f->lobe);
    pst_lobe_data d;
    pst_lobe_prepare(&o, view, f->lobe->shadow, &d);
    if (job->task != PST_FALL_OFF) return fit_lobe(job, i, &d, f->depth ? lights.power : NULL, begun);
    job->fall[i] = fall_off(f, i, &d, &lights, view);
    return 0;
}

static bool stopped(const pst_field *f)
{
    return f->problem->effort && watch_stops(f->problem->effort->watch);
}

static void fit_block(void *context, size_t block)
{
    const pst_field_job *job = context;
    const pst_field *f = job->field;
    if (stopped(f)) return;
    size_t first = job->first + block * BLOCK, end = first + BLOCK < job->end ? first + BLOCK : job->end;
    size_t stride = (size_t)pst_padded(f->problem->capture->count), wanted[BLOCK], count = 0;
    uint32_t pixel[BLOCK];
    gathered g;
    run_start begun = {false, 0};
    for (size_t i = first; i < end; i++) {
        if (!concerns(job, i)) continue;
        pixel[count] = f->pixel[i];
        wanted[count++] = i;
    }
    if (f->problem->effort)
        pst_effort_add(f->problem->effort, job->task == PST_FIT ? FIT_EFFORT * (end - first) : end - first);
    if (count == 0) return;
    pst_gather(f->problem, pixel, count, g.value, g.usable, stride);
    for (size_t j = 0; j < count; j++)
        job->cost[block] += (double)fit_pixel(job, wanted[j], g.value + j * stride, g.usable + j * stride, &begun);
}

status pst_field_run(pst_field_job *job, size_t first, size_t end)
{
    const pst_field *f = job->field;
    const int count = f->problem->capture->count;
    const size_t padded = (size_t)pst_padded(count), blocks = (end - first + BLOCK - 1) / BLOCK;
    float *directions = calloc(3 * padded, sizeof *directions);
    job->cost = calloc(blocks + 1, sizeof *job->cost);
    status s = directions && job->cost ? OK : fail(MERLIN_NO_MEMORY, "no memory to fit %zu pixels", end - first);
    job->x = directions;
    job->y = job->x + padded;
    job->z = job->y + padded;
    job->first = first;
    job->end = end;
    for (int k = 0; k < count && s == OK; k++) {
        job->x[k] = f->problem->light[k].direction[0];
        job->y[k] = f->problem->light[k].direction[1];
        job->z[k] = f->problem->light[k].direction[2];
    }
    if (s == OK) parallel_for(blocks, fit_block, job);
    job->total = 0;
    for (size_t i = 0; i < blocks && s == OK; i++)
        job->total += job->cost[i];
    free(directions);
    free(job->cost);
    return s == OK && stopped(f) ? fail(MERLIN_STOPPED, "stopped") : s;
}

static status run(pst_field_job *job)
{
    return pst_field_run(job, 0, job->field->count);
}

status pst_field_fit(const pst_field *f, double *cost)
{
    pst_field_job job = {.field = f, .task = PST_FIT};
    status s = run(&job);
    *cost = job.total;
    return s;
}

status pst_field_refine(const pst_field *f, double *cost)
{
    pst_field_job job = {.field = f, .task = PST_REFINE};
    status s = run(&job);
    *cost = job.total;
    return s;
}

status pst_field_search(const pst_field *f, float limit)
{
    return run(&(pst_field_job){.field = f, .task = PST_SEARCH, .limit = limit});
}

status pst_field_try_second(const pst_field *f)
{
    return f->second ? run(&(pst_field_job){.field = f, .task = PST_SECOND}) : OK;
}

status pst_field_predict(const pst_field *f, double *cost)
{
    pst_field_job job = {.field = f, .task = PST_PREDICT};
    status s = run(&job);
    *cost = job.total;
    return s;
}

status pst_field_given(const pst_field *f, const img *normal)
{
    for (size_t i = 0; i < f->count; i++)
        f->shading[i].normal = pst_facing(vec3_of(normal->data + 3 * (size_t)f->pixel[i]));
    return run(&(pst_field_job){.field = f, .task = PST_ALBEDO});
}

status pst_field_model(const pst_field *f, float *weight, float *model)
{
    return run(&(pst_field_job){.field = f, .task = PST_MODEL, .weight = weight, .model = model});
}

status pst_field_fall_off(const pst_field *f, pst_fall_off *out)
{
    return run(&(pst_field_job){.field = f, .task = PST_FALL_OFF, .fall = out});
}

size_t pst_field_band(const pst_field *f)
{
    static const size_t many = 1 << 18;
    const size_t row = (size_t)f->problem->capture->width + 2;
    return row > many ? row : many;
}

status pst_field_store(const pst_field *f, merlin_surface *out)
{
    const size_t band = pst_field_band(f);
    status s = OK;
    for (size_t first = 0; first < f->count && s == OK; first += band) {
        const size_t end = first + band < f->count ? first + band : f->count;
        s = pst_field_run(&(pst_field_job){.field = f, .task = PST_STORE, .out = out}, first, end);
        memory_forget(f->shading + first, (end - first) * sizeof *f->shading);
    }
    return s;
}

status pst_field_sample(const pst_problem *p, size_t count, uint32_t **pixel, size_t *found)
{
    size_t n = count < p->pixel_count ? count : p->pixel_count;
    *found = 0;
    *pixel = malloc(n * sizeof **pixel);
    if (!*pixel) return fail(MERLIN_NO_MEMORY, "no memory for a sample of %zu pixels", n);
    for (size_t i = 0; i < n; i++)
        (*pixel)[i] = p->pixel[(2 * i + 1) * p->pixel_count / (2 * n)];
    *found = n;
    return OK;
}
