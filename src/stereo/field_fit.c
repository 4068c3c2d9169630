#include "stereo/field_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "stereo/pixel_fit.h"

/* Pixels gathered at a time: a picture's cache lines serve them all. */
enum { BLOCK = 32 };

typedef enum field_task { FIT, REFINE, FORETELL, SPREAD, MODEL, STORE } field_task;

typedef struct fit_job {
    const pst_field *field;
    field_task task;
    const int32_t *slot;   /* spread */
    const bool *news;      /* spread: whose shading has changed since the neighbours saw it; NULL: all */
    pst_shading *next;     /* spread: to take the place of the field's */
    float *weight, *model; /* model: padded lights a pixel */
    pst_surface *out;      /* store */
    float *x, *y, *z;      /* distant lights, padded */
    float *cost;           /* a pixel */
    double total;
} fit_job;

typedef struct run_start {
    bool valid;
    float cost;
} run_start;

typedef struct gathered {
    float value[BLOCK * PST_MAX_LIGHTS], usable[BLOCK * PST_MAX_LIGHTS]; /* pst_padded(pictures) a pixel */
} gathered;

void pst_gather(const pst_problem *p, const uint32_t *pixel, size_t count, float *value, float *usable, size_t stride)
{
    const pst_capture *c = p->capture;
    float low = p->shadow * 65535 * (float)c->channels, high = p->saturation * 65535;
    for (int k = 0; k < c->count; k++) {
        const float *e = p->light[k].intensity;
        for (size_t j = 0; j < count; j++) {
            const uint16_t *code = c->picture[k] + (size_t)pixel[j] * (size_t)c->channels;
            float sum = 0, top = 0, dark = 0;
            for (int ch = 0; ch < c->channels; ch++) {
                float v = code[ch];
                sum += v / e[ch];
                dark += v;
                top = v > top ? v : top;
            }
            value[j * stride + (size_t)k] = sum / (65535 * (float)c->channels);
            usable[j * stride + (size_t)k] = top < high && (p->shadow <= 0 || dark > low) ? 1 : 0;
        }
    }
    for (size_t j = 0; j < count; j++)
        for (size_t k = (size_t)c->count; k < (size_t)pst_padded(c->count); k++)
            value[j * stride + k] = usable[j * stride + k] = 0;
}

typedef struct near_lights {
    float x[PST_MAX_LIGHTS], y[PST_MAX_LIGHTS], z[PST_MAX_LIGHTS], power[PST_MAX_LIGHTS];
} near_lights;

/* Directions from the point at(0..count) and what arrives there: a point source falls off with the squared distance,
 * an LED also with the lobe's power of the cosine to its axis. */
static void point_lights(const pst_problem *p, vec3 at, int padded, near_lights *out)
{
    for (int k = 0; k < padded; k++)
        out->x[k] = out->y[k] = out->z[k] = out->power[k] = 0;
    int count = p->capture->count;
    for (int k = 0; k < count; k++) {
        const pst_light *from = &p->light[k];
        vec3 to = vec3_sub(from->position, at);
        float squared = fmaxf(vec3_dot(to, to), 1e-12f);
        vec3 l = vec3_scale(to, 1 / sqrtf(squared));
        float power = 1 / squared;
        if (from->lobe > 0 && vec3_dot(from->direction, from->direction) > 0)
            power *= powf(fmaxf(-vec3_dot(l, from->direction), 0), from->lobe);
        out->x[k] = l.x;
        out->y[k] = l.y;
        out->z[k] = l.z;
        out->power[k] = power;
    }
}

static void divide_by_power(const near_lights *l, int padded, float *value, float *usable)
{
    float most = 0;
    for (int k = 0; k < padded; k++)
        most = l->power[k] > most ? l->power[k] : most;
    for (int k = 0; k < padded; k++) {
        bool lit = l->power[k] > 1e-4f * most; /* less is the lobe's dark side: nothing but noise, enlarged */
        value[k] = lit ? value[k] / l->power[k] : 0;
        usable[k] = lit ? usable[k] : 0;
    }
}

/* Albedo a channel by the same weights, and the residual beside the fit. power NULL: distant. */
static void store_pixel(const fit_job *job, size_t at, const pst_lobe_data *d, const pst_shading *q, const float *power)
{
    const pst_problem *p = job->field->problem;
    const pst_capture *c = p->capture;
    const pst_observations *o = &d->seen;
    pst_surface *out = job->out;
    float w[PST_MAX_LIGHTS], model[PST_MAX_LIGHTS];
    pst_lobe_weigh(d, job->field->lobe, q, w, model);
    vec3 n = pst_facing(q->normal);
    float albedo[3] = {0}, energy = 0, fit = 0, residual = 0;
    for (int k = 0; k < c->count; k++) {
        float cosine = fmaxf(n.x * o->x[k] + n.y * o->y[k] + n.z * o->z[k] - job->field->lobe->terminator, 0);
        const uint16_t *code = c->picture[k] + at * (size_t)c->channels;
        float wc = w[k] * cosine, r = o->value[k] - model[k], lobe = model[k] - q->albedo * cosine;
        energy += wc * cosine;
        for (int ch = 0; ch < c->channels && wc > 0; ch++)
            albedo[ch] += wc * ((float)code[ch] / (65535 * p->light[k].intensity[ch] * (power ? power[k] : 1)) - lobe);
        residual += w[k] * r * r;
        fit += w[k] * model[k] * model[k];
    }
    for (int ch = 0; ch < c->channels; ch++)
        albedo[ch] = energy > 1e-12f ? fmaxf(albedo[ch] / energy, 0) : 0;
    memcpy(out->normal.data + 3 * at, &(float[3]){n.x, n.y, n.z}, 3 * sizeof(float));
    memcpy(out->albedo.data + at * (size_t)c->channels, albedo, (size_t)c->channels * sizeof(float));
    out->residual.data[at] = fit > 0 ? sqrtf(residual / fit) : 0;
}

static bool alike(const pst_shading *a, const pst_shading *b)
{
    static const float cosine = 0.9994f; /* of 2 degrees */
    return vec3_dot(a->normal, b->normal) >= cosine;
}

/* Neighbours that differ from the pixel and from each other and cost less; returns how many. */
static int better_neighbours(const fit_job *job, size_t i, const pst_shading *found[4])
{
    static const float cheaper = 0.3f; /* of an outlier */
    static const int step[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    const pst_field *f = job->field;
    const pst_shading *own = &f->shading[i];
    int width = f->problem->capture->width, height = f->problem->capture->height, count = 0;
    int x = (int)(f->pixel[i] % (size_t)width), y = (int)(f->pixel[i] / (size_t)width);
    for (int k = 0; k < 4; k++) {
        int nx = x + step[k][0], ny = y + step[k][1];
        if (nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
        int32_t other = job->slot[(size_t)ny * (size_t)width + (size_t)nx];
        if (other < 0 || (job->news && !job->news[other])) continue;
        const pst_shading *from = &f->shading[other];
        bool known = alike(from, own) || from->cost >= own->cost - cheaper;
        for (int m = 0; m < count; m++)
            known |= alike(from, found[m]);
        if (!known) found[count++] = from;
    }
    return count;
}

/* The pixel before is close to this one, as a rule: what it has is tried first, and serves if it costs no more than
 * where a run of pixels began. Not with few lights: a wrong surface costs no more then, and would be dragged along the
 * row. */
static pst_shading fit_after(const fit_job *job, size_t i, const pst_lobe_data *d, run_start *begun)
{
    const pst_field *f = job->field;
    if (begun->valid && f->problem->capture->count >= PST_MANY_LIGHTS) {
        pst_shading next = pst_lobe_refine(d, f->lobe, &f->shading[i - 1]);
        if (next.cost < begun->cost + 0.3f) return next;
    }
    pst_shading found = pst_lobe_fit(d, f->lobe);
    *begun = (run_start){true, found.cost};
    return found;
}

static void fit_pixel(const fit_job *job, size_t i, float *value, float *usable, run_start *begun)
{
    const pst_field *f = job->field;
    const pst_capture *c = f->problem->capture;
    size_t at = f->pixel[i];
    int padded = pst_padded(c->count);
    near_lights lights;
    pst_observations o = {padded, job->x, job->y, job->z, value, usable, 0};
    vec3 view = {0, 0, 1};
    const pst_shading *start[4];
    int starts = 0;
    if (job->task == SPREAD) {
        starts = better_neighbours(job, i, start);
        job->next[i] = f->shading[i];
        if (starts == 0) return;
    }
    if (f->depth) {
        int x = (int)(at % (size_t)c->width), y = (int)(at / (size_t)c->width);
        vec3 ray = pst_ray(&c->camera, x, y);
        view = vec3_normalize(vec3_scale(ray, -1));
        point_lights(f->problem, vec3_scale(ray, f->scale * f->depth->data[at]), padded, &lights);
        divide_by_power(&lights, padded, value, usable);
        o.x = lights.x;
        o.y = lights.y;
        o.z = lights.z;
    } else if (f->lobe && f->lobe->focal > 0) {
        int x = (int)(at % (size_t)c->width), y = (int)(at / (size_t)c->width);
        view = vec3_normalize(vec3_make((0.5f * (float)c->width - 0.5f - (float)x) / f->lobe->focal,
                                        ((float)y + 0.5f - 0.5f * (float)c->height) / f->lobe->focal, 1));
    }
    if (!f->lobe) {
        float weight[PST_MAX_LIGHTS];
        pst_pixel p = pst_pixel_fit(&o, weight);
        job->cost[i] = p.cost;
        if (f->b) f->b[i] = p.b;
        return;
    }
    if (job->task == FORETELL) {
        job->cost[i] = pst_lobe_foretell(&o, view, f->lobe);
        return;
    }
    pst_lobe_data d;
    pst_lobe_prepare(&o, view, f->lobe->shadow, &d);
    if (job->task == FIT) f->shading[i] = fit_after(job, i, &d, begun);
    if (job->task == REFINE) f->shading[i] = pst_lobe_refine(&d, f->lobe, &f->shading[i]);
    for (int k = 0; k < starts; k++) {
        pst_shading trial = pst_lobe_refine(&d, f->lobe, start[k]);
        if (trial.cost < job->next[i].cost) job->next[i] = trial;
    }
    if (job->task == MODEL)
        pst_lobe_weigh(&d, f->lobe, &f->shading[i], job->weight + i * (size_t)padded, job->model + i * (size_t)padded);
    if (job->task == STORE) store_pixel(job, at, &d, &f->shading[i], f->depth ? lights.power : NULL);
    job->cost[i] = f->shading[i].cost;
}

static void fit_block(void *context, size_t block)
{
    const fit_job *job = context;
    const pst_field *f = job->field;
    size_t first = block * BLOCK, left = f->count - first;
    int count = (int)(left < BLOCK ? left : BLOCK);
    size_t stride = (size_t)pst_padded(f->problem->capture->count);
    gathered g;
    run_start begun = {false, 0};
    memset(g.value, 0, (size_t)count * stride * sizeof *g.value);
    memset(g.usable, 0, (size_t)count * stride * sizeof *g.usable);
    pst_gather(f->problem, f->pixel + first, (size_t)count, g.value, g.usable, stride);
    for (int j = 0; j < count; j++)
        fit_pixel(job, first + (size_t)j, g.value + (size_t)j * stride, g.usable + (size_t)j * stride, &begun);
}

static status run(fit_job *job)
{
    const pst_field *f = job->field;
    int count = f->problem->capture->count;
    if (count > PST_MAX_LIGHTS)
        return fail(ERROR_INPUT, "%d pictures are more than the robust fit's %d; use method ls", count, PST_MAX_LIGHTS);
    size_t padded = (size_t)pst_padded(count);
    float *memory = calloc(3 * padded + f->count, sizeof *memory);
    if (!memory) return fail(ERROR_MEMORY, "no memory to fit %zu pixels", f->count);
    job->x = memory;
    job->y = job->x + padded;
    job->z = job->y + padded;
    job->cost = job->z + padded;
    for (int k = 0; k < count; k++) {
        job->x[k] = f->problem->light[k].direction.x;
        job->y[k] = f->problem->light[k].direction.y;
        job->z[k] = f->problem->light[k].direction.z;
    }
    parallel_for((f->count + BLOCK - 1) / BLOCK, fit_block, job);
    job->total = 0;
    for (size_t i = 0; i < f->count; i++)
        job->total += (double)job->cost[i];
    free(memory);
    return OK;
}

status pst_field_fit(const pst_field *f, double *cost)
{
    fit_job job = {.field = f, .task = FIT};
    status s = run(&job);
    *cost = job.total;
    return s;
}

status pst_field_refine(const pst_field *f, double *cost)
{
    fit_job job = {.field = f, .task = REFINE};
    status s = run(&job);
    *cost = job.total;
    return s;
}

status pst_field_foretell(const pst_field *f, double *cost)
{
    fit_job job = {.field = f, .task = FORETELL};
    status s = run(&job);
    *cost = job.total;
    return s;
}

status pst_field_model(const pst_field *f, float *weight, float *model)
{
    return run(&(fit_job){.field = f, .task = MODEL, .weight = weight, .model = model});
}

status pst_field_store(const pst_field *f, pst_surface *out)
{
    return run(&(fit_job){.field = f, .task = STORE, .out = out});
}

static size_t take(const pst_field *f, const pst_shading *next, bool *news)
{
    size_t moved = 0;
    for (size_t i = 0; i < f->count; i++) {
        news[i] = next[i].cost < f->shading[i].cost;
        moved += news[i];
        f->shading[i] = next[i];
    }
    return moved;
}

status pst_field_spread(const pst_field *f, int sweeps)
{
    const pst_capture *c = f->problem->capture;
    size_t size = (size_t)c->width * (size_t)c->height, moved = 1;
    pst_shading *next = malloc(f->count * sizeof *next);
    int32_t *slot = malloc(size * sizeof *slot);
    bool *news = malloc(f->count * sizeof *news);
    status s = next && slot && news ? OK : fail(ERROR_MEMORY, "no memory to fit %zu pixels", f->count);
    if (s == OK) {
        memset(slot, 0xff, size * sizeof *slot);
        for (size_t i = 0; i < f->count; i++)
            slot[f->pixel[i]] = (int32_t)i;
    }
    for (int k = 0; s == OK && k < sweeps && moved > 0; k++) {
        s = run(&(fit_job){.field = f, .task = SPREAD, .slot = slot, .news = k > 0 ? news : NULL, .next = next});
        if (s == OK) moved = take(f, next, news);
    }
    free(next);
    free(slot);
    free(news);
    return s;
}

status pst_field_sample(const pst_problem *p, size_t count, uint32_t **pixel, size_t *found)
{
    size_t n = count < p->pixel_count ? count : p->pixel_count;
    *found = 0;
    *pixel = malloc(n * sizeof **pixel);
    if (!*pixel) return fail(ERROR_MEMORY, "no memory for a sample of %zu pixels", n);
    for (size_t i = 0; i < n; i++)
        (*pixel)[i] = p->pixel[(2 * i + 1) * p->pixel_count / (2 * n)];
    *found = n;
    return OK;
}
