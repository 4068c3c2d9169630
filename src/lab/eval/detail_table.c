/* SPDX-License-Identifier: MIT */
#include "lab/eval/detail_table.h"

#include <string.h>

#include "base/file.h"
#include "base/progress.h"
#include "estimate/photo/detail.h"
#include "estimate/photo/input.h"
#include "lab/eval/maps.h"
#include "lab/eval/metrics.h"

enum { LIGHTS = 4 };

/* One sample on its way through. */
typedef struct subject {
    const sample *sample;
    img mask, photo; /* the mask 0 or 1, the flash picture saturated at radiance 1 */
    img guide;       /* the photograph, encoded */
    eval_maps truth;
    illumination lights[LIGHTS];
    img targets[LIGHTS]; /* the truth under them */
} subject;

static void subject_free(subject *on)
{
    img_free(&on->mask);
    img_free(&on->photo);
    img_free(&on->guide);
    eval_maps_free(&on->truth);
    for (int i = 0; i < LIGHTS; i++)
        img_free(&on->targets[i]);
}

static status render(const subject *on, const eval_maps *maps, int light, img *out)
{
    const sample *s = on->sample;
    return eval_render(maps, &on->mask, s->fov, s->light_power, &on->lights[light], out);
}

static status subject_new(const sample *s, subject *on)
{
    *on = (subject){.sample = s};
    status st = eval_binary_mask(&s->mask, &on->mask);
    if (st == OK) st = eval_picture(&s->direct, &s->indirect, &on->mask, &on->photo);
    if (st == OK) st = img_copy(&on->guide, &on->photo);
    if (st == OK) surface_encode_guide(&on->guide, 1);
    if (st == OK) st = eval_maps_of_sample(s, &on->truth);
    for (int i = 0; i < LIGHTS && st == OK; i++) {
        on->lights[i] = (illumination){eval_light(s, i), NULL};
        st = render(on, &on->truth, i, &on->targets[i]);
    }
    if (st != OK) subject_free(on);
    return st;
}

/* The network's maps of the photograph in size × size pixels. */
static status see(network *n, const subject *on, int size, int views, surface *out)
{
    img picture = {0}, mask = {0};
    network_estimation e = {0};
    status s = input_make(&on->photo, &on->mask, size, &picture, &mask);
    if (s == OK) s = network_estimate(n, &picture, &mask, NULL, views, NULL, &e);
    if (s == OK) {
        *out = e.maps;
        e.maps = (surface){0};
    }
    img_free(&picture);
    img_free(&mask);
    network_estimation_free(&e);
    return s;
}

static status see_in(network *n, const subject *on, const detail_table *t, detail_way way, surface *out)
{
    detail_request r = {
        .photo = &on->photo, .mask = &on->mask, .gain = 1, .side = t->larger, .views = detail_views(t->views)};
    if (way == DETAIL_LARGE) return see(n, on, t->larger, t->views, out);
    status s = see(n, on, NETWORK_SIZE, t->views, out);
    return s == OK && way == DETAIL_BOTH ? detail_add(n, &r, out) : s;
}

/* At the sample's size, in the network's ranges. */
static status estimate(network *n, const subject *on, const detail_table *t, detail_way way, eval_maps *out)
{
    surface seen = {0}, full = {0};
    status s = see_in(n, on, t, way, &seen);
    if (s == OK) s = surface_refine(&seen, &on->guide, &on->mask, &full);
    surface_free(&seen);
    if (s != OK) return s;
    *out = (eval_maps){full.albedo, full.normal, full.roughness, full.depth};
    img_free(&full.mask);
    eval_to_network_range(&out->albedo);
    eval_to_network_range(&out->roughness);
    return OK;
}

static status similarity(const subject *on, const eval_maps *maps, int light, double *out)
{
    img lit = {0};
    status s = render(on, maps, light, &lit);
    if (s == OK) s = eval_ssim(&lit, &on->targets[light], out);
    img_free(&lit);
    return s;
}

static status add_figures(const subject *on, const eval_maps *maps, double sum[DETAIL_FIGURES])
{
    sum[DETAIL_ALBEDO] += eval_mse(&maps->albedo, &on->truth.albedo, &on->mask);
    sum[DETAIL_NORMAL] += eval_mse(&maps->normal, &on->truth.normal, &on->mask);
    sum[DETAIL_ANGLE] += eval_angle(&maps->normal, &on->truth.normal, &on->mask);
    sum[DETAIL_DEPTH] += eval_mse(&maps->depth, &on->truth.depth, &on->mask);
    sum[DETAIL_ROUGHNESS] += eval_mse(&maps->roughness, &on->truth.roughness, &on->mask);
    for (int i = 0; i < LIGHTS; i++) {
        double one;
        status s = similarity(on, maps, i, &one);
        if (s != OK) return s;
        sum[DETAIL_RELIT] += one / LIGHTS;
    }
    return OK;
}

static status measure(network *n, const sample *s, detail_table *t)
{
    subject on;
    status st = subject_new(s, &on);
    for (int way = 0; way < DETAIL_WAYS && st == OK; way++) {
        eval_maps maps = {0};
        st = estimate(n, &on, t, (detail_way)way, &maps);
        if (st == OK) st = add_figures(&on, &maps, t->mean[way]);
        eval_maps_free(&maps);
    }
    subject_free(&on);
    return st;
}

static status measure_file(network *n, const char *path, detail_table *t)
{
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
    if (st == OK) st = measure(n, &s, t);
    if (st == OK) t->samples++;
    sample_free(&s);
    return st;
}

static status measure_files(const detail_options *o, network *n, char **names, size_t count, detail_table *out)
{
    progress p;
    status s = OK;
    progress_begin(&p, "evaluating", "samples", 0, count, o->quiet);
    for (size_t i = 0; i < count && s == OK; i++) {
        if (o->stopped && o->stopped())
            s = fail(MERLIN_STOPPED, "stopped after %zu of %zu samples", i, count);
        else
            s = measure_file(n, names[i], out);
        if (s == OK) progress_update(&p, i + 1, NULL);
    }
    progress_end(&p);
    for (int i = 0; i < DETAIL_WAYS * DETAIL_FIGURES; i++)
        out->mean[i / DETAIL_FIGURES][i % DETAIL_FIGURES] /= (double)(out->samples ? out->samples : 1);
    return s;
}

status detail_table_run(const detail_options *options, detail_table *out)
{
    *out = (detail_table){.views = options->views};
    double began = clock_seconds();
    char **names;
    size_t count;
    network *n;
    status s = sample_list(options->data, &names, &count);
    if (s != OK) return s;
    s = network_open(options->weights, &n);
    if (s == OK) {
        size_t used = options->count && options->count < count ? options->count : count;
        memcpy(out->model, network_config(n)->name, sizeof out->model);
        s = measure_files(options, n, names, used, out);
        network_close(n);
    }
    file_list_free(names, count);
    out->seconds = clock_seconds() - began;
    return s;
}
