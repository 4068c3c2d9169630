/* SPDX-License-Identifier: MIT */
#include "lab/eval/stereo/solver_table.h"

#include <math.h>
#include <stdlib.h>

#include "base/progress.h"
#include "lab/eval/stereo/rendered_capture.h"
#include "lab/scene/material/material.h"
#include "optics/camera.h"
#include "stereo/integrate/surface_error.h"
#include "stereo/methods/solve.h"

enum { CAPTURES = 4, TIMED_RUNS = 3 };
static const double timed_pixels = 20000;
/* Roughnesses from polished to satin, which the objects have in turn. */
static const float roughness[] = {0.15f, 0.25f, 0.35f, 0.5f};
enum { ROUGHNESSES = sizeof roughness / sizeof *roughness };

typedef struct evaluation {
    const solver_options *options;
    scene_object object;
    solver_row *row;
    progress bar;
    size_t done;
} evaluation;

/* Sets up a glossy object, half as pale, so that highlights stand out and are not clipped. */
static rendered scene_of(const evaluation *e)
{
    return (rendered){.size = e->options->size,
                      .lights = SOLVER_LIGHTS,
                      .strata = 2,
                      .roughness = e->row->roughness,
                      .paleness = 0.5f,
                      .exposure = 3};
}

static status solve(const merlin_capture *c, merlin_stereo_method method, double *angle, size_t *pixels,
                    merlin_surface *out)
{
    status s = pst_solve(c, &(merlin_stereo_params){.method = method}, out);
    if (s != OK) return fail_in(s, "%s", merlin_stereo_method_name(method));
    *angle = normal_mean_angle(&out->normal, c, pixels);
    return OK;
}

static status angle_of(const merlin_capture *c, merlin_stereo_method method, double *angle, size_t *pixels)
{
    merlin_surface found;
    status s = solve(c, method, angle, pixels, &found);
    if (s == OK) merlin_surface_free(&found);
    return s;
}

/* ---- the captures ---- */

static status lambert(const merlin_capture *c, solver_row *row)
{
    return angle_of(c, MERLIN_STEREO_LS, &row->figure[SOLVER_LAMBERT_LS], NULL);
}

static status glossy(const merlin_capture *c, solver_row *row)
{
    status s = angle_of(c, MERLIN_STEREO_LS, &row->figure[SOLVER_GLOSSY_LS], &row->pixels);
    double best = HUGE_VAL;
    for (int i = 0; i < TIMED_RUNS && s == OK; i++) {
        double began = clock_seconds();
        s = angle_of(c, MERLIN_STEREO_ROBUST, &row->figure[SOLVER_GLOSSY_ROBUST], NULL);
        best = fmin(best, clock_seconds() - began);
    }
    if (s == OK) row->figure[SOLVER_ROBUST_TIME] = best * timed_pixels / (double)row->pixels;
    return s;
}

static status near_lights(const merlin_capture *c, double *angle, double *depth)
{
    merlin_surface found;
    status s = solve(c, MERLIN_STEREO_NEAR, angle, NULL, &found);
    if (s != OK) return s;
    *depth = depth_mean_error(&found.depth, c);
    merlin_surface_free(&found);
    return OK;
}

static status near_matte(const merlin_capture *c, solver_row *row)
{
    return near_lights(c, &row->figure[SOLVER_NEAR_MATTE], &row->figure[SOLVER_NEAR_MATTE_DEPTH]);
}

static status near_glossy(const merlin_capture *c, solver_row *row)
{
    return near_lights(c, &row->figure[SOLVER_NEAR_GLOSSY], &row->figure[SOLVER_NEAR_GLOSSY_DEPTH]);
}

typedef status (*capture_figures)(const merlin_capture *c, solver_row *row);

static status measure(evaluation *e, const rendered *how, capture_figures take)
{
    if (e->options->stopped && e->options->stopped()) return fail(MERLIN_STOPPED, "stopped");
    merlin_capture c;
    status s = rendered_capture(how, &e->object, &c);
    if (s != OK) return s;
    s = take(&c, e->row);
    pst_capture_free(&c);
    progress_update(&e->bar, ++e->done, e->row->name);
    return s;
}

static status measure_all(evaluation *e)
{
    rendered smooth = scene_of(e), polished = scene_of(e), leds = scene_of(e);
    smooth.matte = smooth.unshadowed = true;
    smooth.strata = 1; /* a pixel's mean over several normals is not the brightness of one normal */
    leds.leds = true;
    leds.fov = CAMERA_FOV;
    leds.exposure = 0.4f;
    status s = measure(e, &smooth, lambert);
    if (s == OK) s = measure(e, &polished, glossy);
    if (s == OK) s = measure(e, &leds, near_glossy);
    leds.matte = true;
    return s == OK ? measure(e, &leds, near_matte) : s;
}

static status measure_object(evaluation *e, size_t index)
{
    status s = scene_object_generate(e->options->seed, index, CAMERA_FOV, &e->object);
    if (s != OK) return s;
    e->object.material->bumps = 0; /* relief finer than a pixel has no single normal */
    snprintf(e->row->name, sizeof e->row->name, "%zu %s", index, e->object.shape);
    e->row->roughness = roughness[index % ROUGHNESSES];
    s = measure_all(e);
    scene_object_free(&e->object);
    return s == OK ? OK : fail_in(s, "object %zu of seed %llu", index, (unsigned long long)e->options->seed);
}

status solver_table_run(const solver_options *options, solver_table *out)
{
    evaluation e = {.options = options};
    double began = clock_seconds();
    *out = (solver_table){.count = options->count, .object = calloc(options->count, sizeof *out->object)};
    if (!out->object) return fail(MERLIN_NO_MEMORY, "no memory for a table of %zu objects", options->count);
    progress_begin(&e.bar, "photometric stereo", "captures", 0, options->count * CAPTURES, options->quiet);
    status s = OK;
    for (size_t i = 0; i < options->count && s == OK; i++) {
        e.row = &out->object[i];
        s = measure_object(&e, i);
    }
    progress_end(&e.bar);
    out->seconds = clock_seconds() - began;
    if (s != OK) solver_table_free(out);
    return s;
}

void solver_table_free(solver_table *t)
{
    free(t->object);
    *t = (solver_table){0};
}

double solver_table_mean(const solver_table *t, solver_figure figure)
{
    double sum = 0;
    for (size_t i = 0; i < t->count; i++)
        sum += t->object[i].figure[figure];
    return sum / (double)t->count;
}
