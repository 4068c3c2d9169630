/* SPDX-License-Identifier: MIT */
#include "lab/eval/tables/light_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/progress.h"
#include "estimate/light/found_light.h"
#include "estimate/photo/model_pair.h"
#include "lab/eval/metrics/metrics.h"
#include "lab/eval/samples/each_sample.h"
#include "lab/eval/samples/photograph.h"
#include "lab/eval/tables/lit_subject.h"

const float light_angles[LIGHT_LAMPS - 1] = {10, 25, 40, 55};

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

static status photograph(const run *r, const lit_subject *on, const lit_mixture *m, eval_photo *out)
{
    float white = 1;
    img radiance = {0};
    status s = lit_radiance(on, m, &radiance, &white);
    if (s == OK) s = eval_photo_take(on->s, &radiance, &on->s->mask, white, out);
    img_free(&radiance);
    out->params.views = r->options->views;
    if (r->options->lens_unknown) out->params.fov = 0;
    return s;
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
static status judge_direction(run *r, const lit_subject *on, const lit_mixture *m, light_kind kind, vec3 found)
{
    const sample_lamp *l = &on->s->lamps[m->lamp];
    vec3 way = vec3_normalize(l->distant ? l->at : vec3_sub(l->at, vec3_make(0, 0, -1)));
    if (!(vec3_length(found) > 0)) return OK;
    double cosine = (double)vec3_dot(way, vec3_normalize(found));
    return note_direction(&r->found[kind], acos(fmin(fmax(cosine, -1), 1)) / (double)DEGREE);
}

/* Adds how similar the reconstruction is to the photograph. */
static status judge_reconstruction(const eval_photo *photo, const merlin_maps *maps, double *sum)
{
    double similarity = 0;
    img rebuilt = {0};
    status s = eval_photo_cut(photo, &maps->reconstruction, &rebuilt);
    if (s == OK) s = eval_ssim(&rebuilt, &photo->picture, &similarity);
    *sum += similarity;
    img_free(&rebuilt);
    return s;
}

static bool is_seen_as_flash(const run *r, const merlin_maps *maps)
{
    return r->options->flash ? strcmp(maps->model, r->table->flash_model) == 0 : found_light_is_flash(&maps->light);
}

static status measure(run *r, const lit_subject *on, const lit_mixture *m, light_kind kind)
{
    eval_photo photo = {0};
    merlin_maps maps = {0};
    surface found = {0};
    status s = photograph(r, on, m, &photo);
    if (s == OK) s = eval_photo_estimate(r->model, &photo, &maps);
    if (s == OK) s = eval_photo_surface(&photo, &maps, &found);
    if (s == OK && m->lamp >= 0 && r->table->directions)
        s = judge_direction(r, on, m, kind, eval_photo_from_maps(&photo, &maps, vec3_of(maps.light.lamp)));
    if (s == OK) s = judge_reconstruction(&photo, &maps, &r->table->mean[kind][LIGHT_REBUILT]);
    if (s == OK) {
        lit_figures_add(&found, on, r->table->mean[kind]);
        r->table->mean[kind][LIGHT_AS_FLASH] += is_seen_as_flash(r, &maps);
        r->table->count[kind]++;
    }
    surface_free(&found);
    merlin_maps_free(&maps);
    eval_photo_free(&photo);
    return s;
}

static status measure_subject(void *context, const lit_subject *on)
{
    run *r = context;
    const sample *s = on->s;
    status st = measure(r, on, &(lit_mixture){1, 0, -1}, LIGHT_FLASH);
    if (st == OK) st = measure(r, on, &(lit_mixture){1, 0.5f, -1}, LIGHT_FLASH_IN_ROOM);
    if (st == OK) st = measure(r, on, &(lit_mixture){0, 1, -1}, LIGHT_ROOM);
    for (int i = 0; i < s->lamp_count && st == OK; i++)
        st = measure(r, on, &(lit_mixture){0, 0, i}, kind_of_lamp(&s->lamps[i]));
    if (st == OK) st = measure(r, on, &(lit_mixture){0, 0.5f, 0}, LIGHT_LAMP_IN_ROOM);
    if (st == OK) r->table->samples++;
    return st;
}

static status measure_file(void *context, const char *path)
{
    return lit_subject_measure(path, measure_subject, context);
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
