/* SPDX-License-Identifier: MIT */
#include "lab/eval/tables/light_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "base/progress.h"
#include "estimate/light/found_light.h"
#include "estimate/photo/model_pair.h"
#include "estimate/surface/exposure.h"
#include "image/color.h"
#include "lab/eval/metrics/metrics.h"
#include "lab/eval/samples/each_sample.h"
#include "lab/eval/samples/photograph.h"
#include "lab/eval/samples/truth.h"

const float light_angles[LIGHT_LAMPS - 1] = {10, 25, 40, 55};

/* The 95th percentile of the object's luminance, as a share of white: what a camera's automatic exposure makes of it.
 */
static const float EXPOSED = 0.7f, BRIGHT_SHARE = 0.95f;

/* What lights one photograph, and how much of each there is. */
typedef struct mixture {
    float flash, room;
    int lamp; /* -1: none */
} mixture;

typedef struct directions {
    double *angle;
    size_t count, room;
} directions;

typedef struct run {
    const light_options *options;
    merlin_model *model;
    light_table *table;
    directions found[LIGHT_KINDS];
} run;

/* One sample on its way through. */
typedef struct subject {
    const sample *s;
    img mask; /* 1 where the object is, else 0 */
    surface truth;
} subject;

static float angle_of(const sample_lamp *l)
{
    vec3 way = l->distant ? l->at : vec3_sub(l->at, vec3_make(0, 0, -1));
    return acosf(fminf(fmaxf(vec3_normalize(way).z, -1), 1)) / DEGREE;
}

static light_kind kind_of_lamp(const sample_lamp *l)
{
    int class = 0;
    while (class < LIGHT_LAMPS - 1 && angle_of(l) > light_angles[class])
        class ++;
    return (light_kind)(LIGHT_LAMP + class);
}

/* ---- the photograph ---- */

static float mean_luminance(const subject *on, const img *a, const img *b)
{
    double sum = 0, count = 1e-6;
    for (size_t i = 0; i < img_value_count(&on->mask); i++) {
        if (on->mask.data[i] == 0) continue;
        sum += (double)(color_luminance(a->data + 3 * i) + (b ? color_luminance(b->data + 3 * i) : 0));
        count++;
    }
    return (float)(sum / count);
}

static void add(const img *layer, float weight, img *to)
{
    for (size_t i = 0; i < img_value_count(to); i++)
        to->data[i] += weight * layer->data[i];
}

static status bright_part(const subject *on, const img *photo, float *out)
{
    size_t count = 0, pixels = img_value_count(&on->mask);
    float *values = malloc((pixels + 1) * sizeof *values);
    if (!values) return fail(MERLIN_NO_MEMORY, "no memory for a photograph's brightness");
    for (size_t i = 0; i < pixels; i++)
        if (on->mask.data[i] > 0) values[count++] = color_luminance(photo->data + 3 * i);
    qsort(values, count, sizeof *values, number_ascending);
    *out = count ? values[(size_t)(BRIGHT_SHARE * (float)(count - 1))] : 0;
    free(values);
    return OK;
}

static status mix(const subject *on, const mixture *m, img *out)
{
    const sample *s = on->s;
    float flash = mean_luminance(on, &s->direct, &s->indirect), room = mean_luminance(on, &s->env, NULL), main = flash;
    status st = img_new(out, s->mask.width, s->mask.height, 3);
    if (st != OK) return st;
    if (m->flash > 0) add(&s->direct, m->flash, out), add(&s->indirect, m->flash, out);
    if (m->lamp >= 0) {
        const sample_lamp *l = &s->lamps[m->lamp];
        add(&l->direct, 1, out), add(&l->indirect, 1, out);
        main = mean_luminance(on, &l->direct, &l->indirect);
    }
    if (m->room > 0) add(&s->env, room > 0 ? m->room * main / room : 0, out);
    return OK;
}

/* Takes the photograph: a flash alone is exposed as the samples are, everything else by its bright part. */
static status photograph(const run *r, const subject *on, const mixture *m, eval_photo *out)
{
    float bright = 0, white = EXPOSURE_WHITE;
    img radiance = {0};
    status s = mix(on, m, &radiance);
    if (s == OK) s = bright_part(on, &radiance, &bright);
    if (m->room > 0 || m->lamp >= 0) white = bright > 0 ? bright / EXPOSED : 1;
    if (s == OK) s = eval_photo_take(on->s, &radiance, &on->s->mask, white, out);
    img_free(&radiance);
    out->params.views = r->options->views;
    if (r->options->lens_unknown) out->params.fov = 0;
    return s;
}

/* ---- figures ---- */

static double albedo_free(const img *albedo, const subject *on)
{
    double both = 0, own = 0, sum = 0, count = 1e-9;
    const float *a = albedo->data, *b = on->truth.albedo.data;
    for (size_t i = 0; i < img_value_count(albedo); i++) {
        if (on->mask.data[i / 3] == 0) continue;
        both += (double)a[i] * (double)b[i];
        own += (double)a[i] * (double)a[i];
    }
    const double scale = own > 0 ? both / own : 1;
    for (size_t i = 0; i < img_value_count(albedo); i++) {
        if (on->mask.data[i / 3] == 0) continue;
        double e = scale * (double)a[i] - (double)b[i];
        sum += e * e;
        count++;
    }
    return EVAL_UNIT * sum / count;
}

static double relief_error(const img *depth, const subject *on)
{
    double sum = 0, squares = 0, count = 1e-9;
    for (size_t i = 0; i < img_value_count(depth); i++) {
        if (on->mask.data[i] == 0) continue;
        double e = (double)(depth->data[i] - on->truth.depth.data[i]);
        sum += e;
        squares += e * e;
        count++;
    }
    double mean = sum / count, width = 2 * (double)camera_tangent(on->s->fov);
    return sqrt(fmax(squares / count - mean * mean, 0)) / width;
}

static status note_direction(directions *to, double degrees)
{
    if (to->count == to->room) {
        size_t room = 2 * to->room + 64;
        double *grown = realloc(to->angle, room * sizeof *grown);
        if (!grown) return fail(MERLIN_NO_MEMORY, "no memory for directions");
        to->angle = grown;
        to->room = room;
    }
    to->angle[to->count++] = degrees;
    return OK;
}

/* Notes how far off the lamp is, if one is found. */
static status judge_direction(run *r, const subject *on, const mixture *m, light_kind kind, vec3 found)
{
    const sample_lamp *l = &on->s->lamps[m->lamp];
    vec3 way = vec3_normalize(l->distant ? l->at : vec3_sub(l->at, vec3_make(0, 0, -1)));
    if (!(vec3_length(found) > 0)) return OK;
    double cosine = (double)vec3_dot(way, vec3_normalize(found));
    return note_direction(&r->found[kind], acos(fmin(fmax(cosine, -1), 1)) / (double)DEGREE);
}

static void add_figures(const surface *maps, const subject *on, double sum[LIGHT_FIGURES])
{
    sum[LIGHT_ANGLE] += eval_angle(&maps->normal, &on->truth.normal, &on->mask);
    sum[LIGHT_ALBEDO] += EVAL_UNIT * eval_mse(&maps->albedo, &on->truth.albedo, &on->mask);
    sum[LIGHT_ALBEDO_FREE] += albedo_free(&maps->albedo, on);
    sum[LIGHT_ROUGHNESS] += EVAL_UNIT * eval_mse(&maps->roughness, &on->truth.roughness, &on->mask);
    sum[LIGHT_RELIEF] += relief_error(&maps->depth, on);
}

static bool is_seen_as_flash(const run *r, const merlin_maps *maps)
{
    return r->options->flash ? strcmp(maps->model, r->table->flash_model) == 0 : found_light_is_flash(&maps->light);
}

static status measure(run *r, const subject *on, const mixture *m, light_kind kind)
{
    eval_photo photo = {0};
    merlin_maps maps = {0};
    surface found = {0};
    status s = photograph(r, on, m, &photo);
    if (s == OK) s = eval_photo_estimate(r->model, &photo, &maps);
    if (s == OK) s = eval_photo_surface(&photo, &maps, &found);
    if (s == OK && m->lamp >= 0 && r->table->directions)
        s = judge_direction(r, on, m, kind, eval_photo_from_maps(&photo, &maps, vec3_of(maps.light.lamp)));
    if (s == OK) {
        add_figures(&found, on, r->table->mean[kind]);
        r->table->mean[kind][LIGHT_AS_FLASH] += is_seen_as_flash(r, &maps);
        r->table->count[kind]++;
    }
    surface_free(&found);
    merlin_maps_free(&maps);
    eval_photo_free(&photo);
    return s;
}

static status measure_sample(run *r, const sample *s)
{
    subject on = {.s = s};
    status st = eval_binary_mask(&s->mask, &on.mask);
    if (st == OK) st = eval_truth(s, &on.mask, &on.truth);
    if (st == OK) st = measure(r, &on, &(mixture){1, 0, -1}, LIGHT_FLASH);
    if (st == OK) st = measure(r, &on, &(mixture){1, 0.5f, -1}, LIGHT_FLASH_IN_ROOM);
    if (st == OK) st = measure(r, &on, &(mixture){0, 1, -1}, LIGHT_ROOM);
    for (int i = 0; i < s->lamp_count && st == OK; i++)
        st = measure(r, &on, &(mixture){0, 0, i}, kind_of_lamp(&s->lamps[i]));
    if (st == OK) st = measure(r, &on, &(mixture){0, 0.5f, 0}, LIGHT_LAMP_IN_ROOM);
    img_free(&on.mask);
    surface_free(&on.truth);
    return st;
}

static status measure_file(void *context, const char *path)
{
    run *r = context;
    sample s;
    status st = sample_read(path, &s);
    if (st != OK) return st;
    if (s.lamp_count == 0 || !s.env.data)
        st = fail(MERLIN_BAD_INPUT, "%s was rendered without lamps or without environment: render samples with --lamps",
                  path);
    if (st == OK) st = measure_sample(r, &s);
    if (st == OK) r->table->samples++;
    sample_free(&s);
    return st;
}

static void finish(run *r)
{
    light_table *t = r->table;
    for (int kind = 0; kind < LIGHT_KINDS; kind++) {
        directions *d = &r->found[kind];
        for (int f = 0; f < LIGHT_FIGURES; f++)
            t->mean[kind][f] = t->count[kind] ? t->mean[kind][f] / (double)t->count[kind] : (double)NAN;
        t->mean[kind][LIGHT_DIRECTION] = eval_median(d->angle, d->count);
        free(d->angle);
    }
}

static status measure_files(run *r)
{
    const light_options *o = r->options;
    const eval_samples all = {o->data, "evaluating", o->count, o->quiet, o->stopped};
    light_table *t = r->table;
    status s = model_open_pair(o->weights, o->flash, &r->model);
    if (s != OK) return s;
    const network *any = r->model->network, *flash = r->model->flash;
    snprintf(t->model, sizeof t->model, "%s", network_config(any)->name);
    if (flash) snprintf(t->flash_model, sizeof t->flash_model, "%s", network_config(flash)->name);
    t->directions = network_config(any)->lighting == MODEL_LIGHT_ANY;
    s = eval_each_sample(&all, measure_file, r);
    merlin_model_close(r->model);
    return s;
}

status light_table_run(const light_options *options, light_table *out)
{
    *out = (light_table){.samples = 0};
    double began = clock_seconds();
    run r = {.options = options, .table = out};
    status s = measure_files(&r);
    finish(&r);
    out->seconds = clock_seconds() - began;
    return s;
}
