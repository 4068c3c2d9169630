/* SPDX-License-Identifier: MIT */
#include "lab/eval/stereo/unknown_table.h"

#include <math.h>
#include <stdlib.h>

#include "base/file.h"
#include "base/progress.h"
#include "base/rng.h"
#include "estimate/photo/model_pair.h"
#include "lab/eval/metrics/metrics.h"
#include "lab/eval/metrics/normal_frame.h"
#include "lab/eval/stereo/rendered_capture.h"
#include "lab/eval/stereo/stereo_object.h"
#include "lab/scene/material/material.h"
#include "optics/camera.h"
#include "photo_stereo/maps_from_capture.h"
#include "stereo/integrate/surface_error.h"
#include "stereo/methods/solve.h"

typedef struct run {
    const unknown_options *options;
    merlin_model *model;
    progress bar;
    size_t done;
} run;

int unknown_row_pictures(const unknown_object *o, int row)
{
    const int wanted = 1 << row;
    if (row == UNKNOWN_ROWS - 1) return o->pictures & (o->pictures - 1) || o->pictures >= wanted ? o->pictures : 0;
    return wanted <= o->pictures ? wanted : 0;
}

/* Borrows so many of the pictures, evenly chosen, without their lights. */
static status choose(const merlin_capture *all, int count, bool lens_unknown, merlin_capture *out)
{
    *out = *all;
    out->count = count;
    if (lens_unknown) out->camera = (pinhole){0};
    out->lighting = MERLIN_UNKNOWN_LIGHTS;
    out->picture = calloc((size_t)count, sizeof *out->picture);
    out->light = calloc((size_t)count, sizeof *out->light);
    out->name = NULL;
    for (int i = 0; i < count && out->picture; i++)
        out->picture[i] = all->picture[(long)i * all->count / count];
    for (int i = 0; i < count && out->light; i++)
        out->light[i].intensity[0] = out->light[i].intensity[1] = out->light[i].intensity[2] = 1;
    return out->picture && out->light ? OK : fail(MERLIN_NO_MEMORY, "no memory for %d pictures", count);
}

/* Exposes the pictures to shares from `least` to 1, as a camera that is left to itself does. */
static status dim_pictures(float least, size_t index, merlin_capture *c)
{
    const size_t values = (size_t)c->width * (size_t)c->height * (size_t)c->channels;
    status s = OK;
    for (int k = 0; k < c->count && s == OK; k++) {
        rng r = rng_at(index, (uint64_t)k, 0);
        const float share = rng_range(&r, least, 1);
        s = pst_plane_widen(&c->picture[k], values);
        for (size_t i = 0; i < values && s == OK; i++)
            c->picture[k].wide[i] = (uint16_t)(share * (float)c->picture[k].wide[i] + 0.5f);
    }
    return s;
}

/* Maps to compare with the truth; without albedo where a solver's has another meaning. */
typedef struct solution {
    img normal, albedo, spread;
} solution;

static void solution_free(solution *s)
{
    img_free(&s->normal);
    img_free(&s->albedo);
    img_free(&s->spread);
}

static status solve(const run *r, const merlin_capture *c, unknown_way way, solution *out)
{
    merlin_params params = merlin_params_default();
    params.views = r->options->views;
    params.stop = r->options->stopped;
    params.near_network = r->options->near;
    if (way == UNKNOWN_UNCALIBRATED) {
        const merlin_stereo_params how = {.method = MERLIN_STEREO_UNCALIBRATED, .stop = r->options->stopped};
        merlin_surface found;
        status s = pst_solve(c, &how, &found);
        if (s != OK) return s;
        *out = (solution){.normal = found.normal, .spread = found.spread};
        found.normal = found.spread = (img){0};
        merlin_surface_free(&found);
        return OK;
    }
    merlin_maps maps;
    status s = maps_of_capture(r->model, c, &params, way == UNKNOWN_REFINED, &maps);
    if (s != OK) return s;
    *out = (solution){maps.normal, maps.albedo, maps.spread};
    maps.normal = maps.albedo = maps.spread = (img){0};
    merlin_maps_free(&maps);
    return OK;
}

/* A pixel's spread and error. */
typedef struct doubted {
    float spread, error;
} doubted;

static int by_spread(const void *a, const void *b)
{
    const float x = ((const doubted *)a)->spread, y = ((const doubted *)b)->spread;
    return (x > y) - (x < y);
}

/* Computes the mean error of the half of the pixels whose spread is least: the less it is, the better the spread tells
 * where normals are wrong. */
static status error_of_surest(const solution *found, const merlin_capture *c, double *out)
{
    const size_t pixels = (size_t)c->width * (size_t)c->height;
    size_t count = 0;
    double sum = 0;
    doubted *all = malloc(pixels * sizeof *all);
    if (!all) return fail(MERLIN_NO_MEMORY, "no memory for %zu pixels", pixels);
    for (size_t i = 0; i < pixels; i++) {
        const vec3 truth = vec3_of(c->normal_true.data + 3 * i);
        if (!(c->mask.data[i] > 0.5f) || vec3_length(truth) < 0.5f) continue;
        const float error = (float)vec3_angle(vec3_of(found->normal.data + 3 * i), truth);
        all[count++] = (doubted){found->spread.data[i], error};
    }
    qsort(all, count, sizeof *all, by_spread);
    const size_t half = count / 2;
    for (size_t i = 0; i < half; i++)
        sum += (double)all[i].error;
    *out = half > 0 ? sum / (double)half : (double)NAN;
    free(all);
    return OK;
}

/* Measures one way's result, if there is one. */
static status measure_solution(const stereo_object *o, const solution *found, unknown_way way, int row,
                               unknown_object *out)
{
    out->error[row][way] = normal_mean_angle(&found->normal, &o->capture, NULL);
    if (found->albedo.data && o->albedo.data)
        out->albedo[row][way] = EVAL_UNIT * eval_mse_scale_free(&found->albedo, &o->albedo, &o->capture.mask);
    return found->spread.data ? error_of_surest(found, &o->capture, &out->surest[row][way]) : OK;
}

/* A capture that a solver can make nothing of is a result, too. */
static status measure(run *r, const stereo_object *o, int count, int row, unknown_object *out)
{
    merlin_capture c;
    status s = choose(&o->capture, count, r->options->lens_unknown, &c);
    for (int way = 0; way < UNKNOWN_WAYS && s == OK; way++) {
        solution found = {0};
        s = r->options->stopped && r->options->stopped() ? fail(MERLIN_STOPPED, "stopped")
                                                         : solve(r, &c, (unknown_way)way, &found);
        if (s == OK) s = measure_solution(o, &found, (unknown_way)way, row, out);
        if (s == MERLIN_BAD_INPUT) s = OK;
        solution_free(&found);
        progress_update(&r->bar, ++r->done, o->name);
    }
    free(c.picture);
    free(c.light);
    return s;
}

/* Renders an object under distant lights, as seen from afar. */
static status render(const run *r, size_t index, stereo_object *out)
{
    const rendered how = {
        .size = STEREO_OBJECT_SIDE, .lights = UNKNOWN_LIGHTS, .strata = 2, .exposure = 2, .albedo = &out->albedo};
    scene_object object;
    *out = (stereo_object){.name = ""};
    status s = scene_object_generate(r->options->seed, index, CAMERA_FOV, &object);
    if (s != OK) return s;
    object.material->bumps = 0; /* relief finer than a pixel has no single normal */
    snprintf(out->name, sizeof out->name, "%zu %.20s", index, object.shape);
    s = rendered_capture(&how, &object, &out->capture);
    scene_object_free(&object);
    return s;
}

/* path: NULL for a rendered object. */
static status measure_object(run *r, const char *path, size_t index, unknown_object *out)
{
    stereo_object o;
    status s = path ? stereo_object_read(path, &o) : render(r, index, &o);
    if (s != OK) return s;
    if (r->options->dim > 0) s = dim_pictures(r->options->dim, index, &o.capture);
    snprintf(out->name, sizeof out->name, "%s", o.name);
    out->pictures = o.capture.count;
    for (int row = 0; row < UNKNOWN_ROWS; row++) {
        for (int way = 0; way < UNKNOWN_WAYS; way++)
            out->error[row][way] = out->albedo[row][way] = out->surest[row][way] = (double)NAN;
        const int count = unknown_row_pictures(out, row);
        if (count > 0 && s == OK) s = measure(r, &o, count, row, out);
    }
    stereo_object_free(&o);
    return s == OK || s == MERLIN_STOPPED ? s : fail_in(s, "%s", out->name);
}

static status measure_all(run *r, char **path, unknown_table *out)
{
    out->object = calloc(out->count, sizeof *out->object);
    if (!out->object) return fail(MERLIN_NO_MEMORY, "no memory for a table of %zu objects", out->count);
    status s = model_open_several(r->options->weights, r->options->several, &r->model);
    if (s != OK) return s;
    snprintf(out->model, sizeof out->model, "%s", merlin_model_name(r->model));
    const size_t solutions = (size_t)UNKNOWN_ROWS * UNKNOWN_WAYS;
    progress_begin(&r->bar, "unknown lights", "solutions", 0, out->count * solutions, r->options->quiet);
    for (size_t i = 0; i < out->count && s == OK; i++) {
        s = measure_object(r, path ? path[i] : NULL, i, &out->object[i]);
        r->done = (i + 1) * solutions;
    }
    progress_end(&r->bar);
    merlin_model_close(r->model);
    return s;
}

status unknown_table_run(const unknown_options *options, unknown_table *out)
{
    *out = (unknown_table){.count = 0};
    const double began = clock_seconds();
    run r = {.options = options};
    char **path = NULL;
    size_t count = options->count ? options->count : UNKNOWN_RENDERED;
    status s = options->data ? stereo_object_list(options->data, &path, &count) : OK;
    if (s != OK) return s;
    out->count = options->count && options->count < count ? options->count : count;
    s = measure_all(&r, path, out);
    if (path) file_list_free(path, count);
    out->seconds = clock_seconds() - began;
    if (s != OK) unknown_table_free(out);
    return s;
}

void unknown_table_free(unknown_table *t)
{
    free(t->object);
    *t = (unknown_table){.count = 0};
}
