/* SPDX-License-Identifier: MIT */
#include "lab/eval/tables/detail_table.h"

#include "base/progress.h"
#include "estimate/photo/detail.h"
#include "estimate/photo/input.h"
#include "estimate/photo/model_pair.h"
#include "estimate/surface/exposure.h"
#include "lab/eval/metrics/metrics.h"
#include "lab/eval/samples/each_sample.h"
#include "lab/eval/samples/photograph.h"
#include "lab/eval/samples/truth.h"

enum { LIGHTS = 4 };

/* One sample on its way through. */
typedef struct subject {
    const sample *sample;
    img mask; /* 1 where the object is, else 0 */
    eval_photo photo;
    surface truth;
    float gain; /* as merlin_estimate found it, for the larger picture, too */
} subject;

static void subject_free(subject *on)
{
    img_free(&on->mask);
    eval_photo_free(&on->photo);
    surface_free(&on->truth);
}

static status subject_new(const sample *s, int views, subject *on)
{
    img radiance = {0};
    *on = (subject){.sample = s};
    status st = eval_binary_mask(&s->mask, &on->mask);
    if (st == OK) st = img_copy(&radiance, &s->direct);
    if (st == OK) img_add(&s->indirect, &radiance);
    if (st == OK) st = eval_photo_take(s, &radiance, &s->mask, EXPOSURE_WHITE, &on->photo);
    if (st == OK) st = eval_truth(s, &s->mask, &on->truth);
    img_free(&radiance);
    on->photo.params.views = views;
    if (st != OK) subject_free(on);
    return st;
}

/* Asks merlin_estimate, which sees the larger picture, too, if size is larger. */
static status estimate(merlin_model *model, subject *on, int size, surface *out)
{
    merlin_maps maps = {0};
    on->photo.params.size = size;
    status s = eval_photo_estimate(model, &on->photo, &maps);
    if (s == OK) s = eval_photo_surface(&on->photo, &maps, out);
    on->gain = maps.gain;
    merlin_maps_free(&maps);
    return s;
}

/* Does what merlin_estimate does not: all maps of the larger picture. */
static status see_large(merlin_model *model, const subject *on, int size, surface *out)
{
    img picture = {0}, mask = {0}, guide = {0};
    network_estimation e = {0};
    const sight how = {.lens = on->photo.lens};
    status s = input_make(&on->photo.picture, &on->photo.mask, size, &picture, &mask);
    if (s == OK) input_expose(&picture, on->gain);
    if (s == OK) s = network_estimate(model->network, &picture, &mask, &how, on->photo.params.views, NULL, &e);
    if (s == OK) s = img_copy(&guide, &on->photo.picture);
    if (s == OK) surface_encode_guide(&guide, on->gain);
    if (s == OK) s = surface_refine(&e.maps, &guide, &on->photo.mask, out);
    img_free(&picture);
    img_free(&mask);
    img_free(&guide);
    network_estimation_free(&e);
    return s;
}

static status find(merlin_model *model, subject *on, const detail_table *t, detail_way way, surface *out)
{
    if (way == DETAIL_LARGE) return see_large(model, on, t->larger, out);
    return estimate(model, on, way == DETAIL_SMALL ? NETWORK_SIZE : NETWORK_LARGEST_SIZE, out);
}

static status similarity(const subject *on, const surface *maps, int light, double *out)
{
    const illumination by = {eval_light(on->sample, light), NULL};
    img lit = {0}, target = {0};
    status s = eval_render(maps, &by, on->photo.white / on->gain, &lit);
    if (s == OK) s = eval_render(&on->truth, &by, 1, &target);
    if (s == OK) s = eval_ssim(&lit, &target, out);
    img_free(&lit);
    img_free(&target);
    return s;
}

static status add_figures(const subject *on, const surface *maps, double sum[DETAIL_FIGURES])
{
    sum[DETAIL_ALBEDO] += EVAL_UNIT * eval_mse(&maps->albedo, &on->truth.albedo, &on->mask);
    sum[DETAIL_NORMAL] += eval_mse(&maps->normal, &on->truth.normal, &on->mask);
    sum[DETAIL_ANGLE] += eval_angle(&maps->normal, &on->truth.normal, &on->mask);
    sum[DETAIL_DEPTH] += eval_mse(&maps->depth, &on->truth.depth, &on->mask);
    sum[DETAIL_ROUGHNESS] += EVAL_UNIT * eval_mse(&maps->roughness, &on->truth.roughness, &on->mask);
    for (int i = 0; i < LIGHTS; i++) {
        double one;
        status s = similarity(on, maps, i, &one);
        if (s != OK) return s;
        sum[DETAIL_RELIT] += one / LIGHTS;
    }
    return OK;
}

static status measure(merlin_model *model, const sample *s, detail_table *t)
{
    subject on;
    status st = subject_new(s, t->views, &on);
    for (int way = 0; way < DETAIL_WAYS && st == OK; way++) {
        surface maps = {0};
        st = find(model, &on, t, (detail_way)way, &maps);
        if (st == OK) st = add_figures(&on, &maps, t->mean[way]);
        surface_free(&maps);
    }
    subject_free(&on);
    return st;
}

typedef struct run {
    merlin_model *model;
    detail_table *table;
} run;

static status measure_file(void *context, const char *path)
{
    const run *r = context;
    detail_table *t = r->table;
    sample s;
    status st = sample_read_training(path, &s);
    if (st != OK) return st;
    int first = t->samples == 0 ? s.mask.width : t->size;
    t->size = first;
    t->larger = detail_side(NETWORK_LARGEST_SIZE, first);
    if (s.mask.width != first || s.mask.height != first)
        st = fail(MERLIN_BAD_INPUT, "%s is %dx%d but the first sample is %dx%d", path, s.mask.width, s.mask.height,
                  first, first);
    else if (t->larger == 0)
        st = fail(MERLIN_BAD_INPUT, "%s: samples of %d pixels a side show nothing finer than %d do; render larger ones",
                  path, first, NETWORK_SIZE);
    if (st == OK) st = measure(r->model, &s, t);
    if (st == OK) t->samples++;
    sample_free(&s);
    return st;
}

status detail_table_run(const detail_options *o, detail_table *out)
{
    *out = (detail_table){.views = o->views};
    double began = clock_seconds();
    const eval_samples all = {o->data, "evaluating", o->count, o->quiet, o->stopped};
    run r = {.table = out};
    status s = merlin_model_open(o->weights, &r.model);
    if (s != OK) return s;
    snprintf(out->model, sizeof out->model, "%s", merlin_model_name(r.model));
    s = eval_each_sample(&all, measure_file, &r);
    for (int i = 0; i < DETAIL_WAYS * DETAIL_FIGURES; i++)
        out->mean[i / DETAIL_FIGURES][i % DETAIL_FIGURES] /= (double)(out->samples ? out->samples : 1);
    merlin_model_close(r.model);
    out->seconds = clock_seconds() - began;
    return s;
}
