/* SPDX-License-Identifier: MIT */
#include "lab/eval/stereo/picture_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/progress.h"
#include "estimate/photo/model_pair.h"
#include "lab/eval/metrics/normal_frame.h"
#include "lab/eval/stereo/stereo_frame.h"
#include "lab/eval/stereo/stereo_object.h"
#include "stereo/integrate/surface_error.h"
#include "stereo/methods/solve.h"

typedef struct run {
    const picture_options *options;
    merlin_model *model;
    progress bar;
    size_t done;
} run;

/* ---- one picture ---- */

/* Returns how far a light stands aside, in degrees; NAN of a near one, whose direction differs from place to place. */
static double aside_of(const merlin_capture *c, int i)
{
    if (c->lighting != MERLIN_DISTANT_LIGHTS) return (double)NAN;
    return vec3_angle(vec3_of(c->light[i].direction), vec3_make(0, 0, 1));
}

static double light_error(const merlin_capture *c, int i, const merlin_found_light *found)
{
    vec3 way = vec3_of(found->lamp);
    if (c->lighting != MERLIN_DISTANT_LIGHTS || !found->known || !(vec3_length(way) > 0)) return (double)NAN;
    return vec3_angle(vec3_of(c->light[i].direction), way);
}

static status score_maps(const merlin_capture *c, const merlin_maps *maps, picture_score *score)
{
    img normal = {0};
    /* A model of any light says how a surface stands, not how it is turned against its pixel's line of sight. */
    const bool by_sight = !maps->light.known;
    const img from = maps->normal;
    const pinhole assumed = pinhole_of(c->width, c->height, CAMERA_FOV);
    status s = stereo_frame_check(c, maps);
    if (s == OK) s = img_copy(&normal, &from);
    if (s != OK) return s;
    if (by_sight) normal_frame_change(&normal, &assumed, &c->camera);
    score->error = normal_mean_angle(&normal, c, NULL);
    img_free(&normal);
    return OK;
}

static status measure(run *r, const merlin_capture *c, int i, picture_score *score)
{
    merlin_maps maps = {0};
    img photo = {0};
    snprintf(score->name, sizeof score->name, "%s", file_name_of(c->name[i]));
    status s = stereo_object_photo(c, i, &photo);
    if (s == OK) s = merlin_estimate(r->model, &photo, &c->mask, NULL, &maps);
    if (s == OK) s = score_maps(c, &maps, score);
    score->aside = aside_of(c, i);
    score->light = light_error(c, i, &maps.light);
    score->as_flash = r->options->flash && !maps.light.known;
    merlin_maps_free(&maps);
    img_free(&photo);
    return s;
}

/* ---- an object ---- */

static status find_truth(merlin_capture *c)
{
    if (c->normal_true.data) return OK;
    merlin_surface solved;
    status s = pst_solve(c, &(merlin_stereo_params){.method = MERLIN_STEREO_AUTO}, &solved);
    if (s != OK) return s;
    c->normal_true = solved.normal;
    solved.normal = (img){0};
    merlin_surface_free(&solved);
    return OK;
}

static status measure_all(run *r, const merlin_capture *c, picture_column *out)
{
    out->picture = calloc((size_t)c->count, sizeof *out->picture);
    if (!out->picture) return fail(MERLIN_NO_MEMORY, "no memory for a table of %d pictures", c->count);
    out->count = c->count;
    out->frontal = stereo_object_frontal(c);
    status s = OK;
    for (int i = 0; i < c->count && s == OK; i++) {
        progress_update(&r->bar, 1000 * r->done + (size_t)(1000 * i / c->count), out->name);
        s = r->options->stopped && r->options->stopped() ? fail(MERLIN_STOPPED, "stopped")
                                                         : measure(r, c, i, &out->picture[i]);
    }
    return s;
}

static status measure_folder(run *r, const char *folder, picture_column *out)
{
    merlin_capture c = {0};
    snprintf(out->name, sizeof out->name, "%s", file_name_of(folder));
    status s = pst_capture_read(
        folder, &(merlin_capture_files){.lights = r->options->lights, .linear = r->options->linear}, &c);
    if (s == OK) s = stereo_frame(&c, NULL, STEREO_OBJECT_SIDE);
    out->true_normals = c.normal_true.data != NULL;
    if (s == OK) s = find_truth(&c);
    if (s == OK) s = measure_all(r, &c, out);
    pst_capture_free(&c);
    return s == OK ? OK : fail_in(s, "%s", folder);
}

status picture_table_run(const picture_options *options, picture_table *out)
{
    run r = {.options = options};
    double began = clock_seconds();
    *out = (picture_table){.object = calloc(options->count + 1, sizeof *out->object), .count = options->count};
    if (!out->object) return fail(MERLIN_NO_MEMORY, "no memory for a table of %zu objects", options->count);
    status s = model_open_pair(options->weights, options->flash, &r.model);
    if (s == OK) snprintf(out->model, sizeof out->model, "%s", merlin_model_name(r.model));
    progress_begin(&r.bar, "estimating", "thousandths", 0, 1000 * options->count, options->quiet);
    for (; r.done < options->count && s == OK; r.done++)
        s = measure_folder(&r, options->folder[r.done], &out->object[r.done]);
    progress_end(&r.bar);
    merlin_model_close(r.model);
    out->seconds = clock_seconds() - began;
    if (s != OK) picture_table_free(out);
    return s;
}

void picture_table_free(picture_table *t)
{
    for (size_t i = 0; t->object && i < t->count; i++)
        free(t->object[i].picture);
    free(t->object);
    *t = (picture_table){.count = 0};
}
