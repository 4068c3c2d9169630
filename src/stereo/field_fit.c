#include "stereo/field_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "stereo/pixel_fit.h"

/* Pixels gathered at a time: a picture's cache lines serve them all. */
enum { BLOCK = 16 };

typedef struct fit_job {
    const pst_field *field;
    float *x, *y, *z; /* distant lights, padded */
    float *cost;      /* a pixel */
} fit_job;

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
static void store(const fit_job *job, size_t at, const pst_observations *o, const float *w, const float *power, vec3 b)
{
    const pst_problem *p = job->field->problem;
    const pst_capture *c = p->capture;
    pst_surface *out = job->field->out;
    vec3 n = pst_facing(b);
    float albedo[3] = {0}, energy = 0, fit = 0, residual = 0, length = vec3_length(b);
    for (int k = 0; k < c->count; k++) {
        float cosine = fmaxf(n.x * o->x[k] + n.y * o->y[k] + n.z * o->z[k] - o->terminator, 0), wc = w[k] * cosine;
        const uint16_t *code = c->picture[k] + at * (size_t)c->channels;
        energy += wc * cosine;
        for (int ch = 0; ch < c->channels && wc > 0; ch++)
            albedo[ch] += wc * (float)code[ch] / (65535 * p->light[k].intensity[ch] * (power ? power[k] : 1));
        float r = o->value[k] - length * cosine;
        residual += w[k] * r * r;
        fit += w[k] * length * cosine * length * cosine;
    }
    for (int ch = 0; ch < c->channels; ch++)
        albedo[ch] = energy > 1e-12f ? albedo[ch] / energy : 0;
    memcpy(out->normal.data + 3 * at, &(float[3]){n.x, n.y, n.z}, 3 * sizeof(float));
    memcpy(out->albedo.data + at * (size_t)c->channels, albedo, (size_t)c->channels * sizeof(float));
    out->residual.data[at] = fit > 0 ? sqrtf(residual / fit) : 0;
}

static pst_pixel fit_pixel(const fit_job *job, size_t at, float *value, float *usable)
{
    const pst_field *f = job->field;
    const pst_capture *c = f->problem->capture;
    int padded = pst_padded(c->count);
    near_lights lights;
    float weight[PST_MAX_LIGHTS];
    pst_observations o = {padded, job->x, job->y, job->z, value, usable, f->terminator};
    if (f->depth) {
        int x = (int)(at % (size_t)c->width), y = (int)(at / (size_t)c->width);
        point_lights(f->problem, vec3_scale(pst_ray(&c->camera, x, y), f->scale * f->depth->data[at]), padded, &lights);
        divide_by_power(&lights, padded, value, usable);
        o.x = lights.x;
        o.y = lights.y;
        o.z = lights.z;
    }
    pst_pixel p = pst_pixel_fit(&o, weight);
    if (f->out) store(job, at, &o, weight, f->depth ? lights.power : NULL, p.b);
    return p;
}

static void fit_block(void *context, size_t block)
{
    const fit_job *job = context;
    const pst_field *f = job->field;
    size_t first = block * BLOCK, left = f->count - first;
    int count = (int)(left < BLOCK ? left : BLOCK);
    size_t stride = (size_t)pst_padded(f->problem->capture->count);
    gathered g;
    memset(g.value, 0, (size_t)count * stride * sizeof *g.value);
    memset(g.usable, 0, (size_t)count * stride * sizeof *g.usable);
    pst_gather(f->problem, f->pixel + first, (size_t)count, g.value, g.usable, stride);
    for (int j = 0; j < count; j++) {
        size_t i = first + (size_t)j;
        pst_pixel p = fit_pixel(job, f->pixel[i], g.value + (size_t)j * stride, g.usable + (size_t)j * stride);
        job->cost[i] = p.cost;
        if (f->b) f->b[i] = p.b;
    }
}

status pst_field_fit(const pst_field *f, double *cost)
{
    int count = f->problem->capture->count;
    if (count > PST_MAX_LIGHTS)
        return fail(ERROR_INPUT, "%d pictures are more than the robust fit's %d; use method ls", count, PST_MAX_LIGHTS);
    size_t padded = (size_t)pst_padded(count);
    float *memory = calloc(3 * padded + f->count, sizeof *memory);
    if (!memory) return fail(ERROR_MEMORY, "no memory to fit %zu pixels", f->count);
    fit_job job = {f, memory, memory + padded, memory + 2 * padded, memory + 3 * padded};
    for (int k = 0; k < count; k++) {
        job.x[k] = f->problem->light[k].direction.x;
        job.y[k] = f->problem->light[k].direction.y;
        job.z[k] = f->problem->light[k].direction.z;
    }
    parallel_for((f->count + BLOCK - 1) / BLOCK, fit_block, &job);
    *cost = 0;
    for (size_t i = 0; i < f->count; i++)
        *cost += (double)job.cost[i];
    free(memory);
    return OK;
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
