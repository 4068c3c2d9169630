/* SPDX-License-Identifier: MIT */
/* merlin_stereo_from_maps: photometric stereo from one photograph. Its maps are relit under many near lights, and
 * random subsets of these pictures are solved. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/api_needs.h"
#include "base/progress.h"
#include "merlin/surface.h"
#include "photo_stereo/relit.h"
#include "photo_stereo/subsets.h"
#include "stereo/integrate/integrate.h"

enum { LARGEST_SIDE = 512 };

/* All relit pictures, and the normals that their subsets gave. */
typedef struct work {
    const merlin_stereo_params *params;
    watch watch;
    relit relit;
    img normals[SUBSETS];
    int solved;
    merlin_stereo_method method; /* the one used */
} work;

/* ---- solving ---- */

static status solve_subset(work *w, int subset)
{
    merlin_surface found;
    status s = subset_solve(&w->relit.capture, subset, w->params->method, &found);
    if (s != OK) return s;
    w->method = found.method;
    w->normals[w->solved++] = found.normal;
    found.normal = (img){0};
    merlin_surface_free(&found);
    return OK;
}

static status solve_all(work *w)
{
    status s = OK;
    for (int i = 0; i < SUBSETS && s == OK; i++) {
        watch_tell(&w->watch, "solving", (double)i / SUBSETS);
        s = watch_stops(&w->watch) ? fail(MERLIN_STOPPED, "stopped") : solve_subset(w, i);
    }
    if (s == OK) watch_tell(&w->watch, "solving", 1);
    return s;
}

/* ---- mean and spread ---- */

static vec3 normal_at(const img *normal, size_t pixel)
{
    return vec3_of(normal->data + 3 * pixel);
}

/* Averages the normals of one pixel; returns the root mean square of their angles to the mean, in degrees. */
static float average(const work *w, size_t pixel, float *mean)
{
    vec3 sum = {0, 0, 0};
    for (int i = 0; i < SUBSETS; i++)
        sum = vec3_add(sum, normal_at(&w->normals[i], pixel));
    sum = vec3_normalize(sum);
    vec3_put(sum, mean);
    float square = 0;
    for (int i = 0; i < SUBSETS; i++) {
        float a = (float)vec3_angle(normal_at(&w->normals[i], pixel), sum);
        square += a * a / SUBSETS;
    }
    return sqrtf(square);
}

/* Takes the maps' normal where the subsets contradict each other, as they do along an outline that few lights reach. */
static bool keep_normal(const work *w, size_t pixel, merlin_surface *out)
{
    if (out->residual.data[pixel] <= MERLIN_SPREAD_LIMIT) return false;
    memcpy(out->normal.data + 3 * pixel, w->relit.maps.normal.data + 3 * pixel, 3 * sizeof(float));
    return true;
}

static void average_all(const work *w, merlin_surface *out)
{
    double spread = 0, angle = 0;
    merlin_relit_photo *r = &out->relit;
    for (size_t i = 0, pixels = img_value_count(&out->mask); i < pixels; i++) {
        if (out->mask.data[i] <= 0.5f) continue;
        out->residual.data[i] = average(w, i, out->normal.data + 3 * i);
        spread += (double)out->residual.data[i];
        angle += vec3_angle(normal_at(&out->normal, i), normal_at(&w->relit.maps.normal, i));
        r->pixels_left += keep_normal(w, i, out);
        r->pixels++;
    }
    if (r->pixels == 0) return;
    r->spread = spread / (double)r->pixels;
    r->angle = angle / (double)r->pixels;
}

static status surface_new_from(const work *w, merlin_surface *out)
{
    const int side = w->relit.capture.width;
    *out = (merlin_surface){.camera = w->relit.capture.camera,
                            .keep_edges = w->params->keep_edges != 0,
                            .relit = {RELIT_LIGHTS, SUBSETS, SUBSET_PICTURES, .pixels = 0}};
    status s = img_copy(&out->mask, &w->relit.capture.mask);
    if (s == OK) s = img_new(&out->normal, side, side, 3);
    /* the pictures were rendered from it: a solver can only blur it with highlights */
    if (s == OK) s = img_copy(&out->albedo, &w->relit.maps.albedo);
    if (s == OK) s = img_new(&out->residual, side, side, 1);
    return s;
}

static status integrate(const work *w, merlin_surface *out)
{
    const pst_integration how = {.preserve_edges = w->params->keep_edges != 0, .watch = &w->watch};
    watch_tell(&w->watch, "integrating", 0);
    return pst_integrate(&out->normal, &out->mask, &out->camera, &how, &out->depth);
}

static status make(merlin_model *model, const merlin_maps *maps, work *w, merlin_surface *out)
{
    const double began = clock_seconds();
    const int side = maps->crop.side < LARGEST_SIDE ? maps->crop.side : LARGEST_SIDE;
    status s = relit_new(model, maps, side, RELIT_BY, w->params->stop, &w->relit);
    const double rendered = clock_seconds();
    if (s == OK) s = surface_new_from(w, out);
    if (s == OK) s = solve_all(w);
    const double solved = clock_seconds();
    if (s == OK) average_all(w, out);
    if (s == OK) s = integrate(w, out);
    const double ended = clock_seconds();
    out->method = w->method;
    out->seconds.read = rendered - began;
    out->seconds.solve = solved - rendered;
    out->seconds.integrate = ended - solved;
    out->seconds.total = ended - began;
    if (s != OK) return s;
    snprintf(out->relit.model, sizeof out->relit.model, "%s", merlin_relighting_model(model, maps, RELIT_BY));
    merlin_maps_warnings(maps, &out->warnings);
    merlin_relighting_warnings(model, maps, RELIT_BY, &out->warnings);
    return OK;
}

static status check(const merlin_maps *maps, const merlin_stereo_params *params)
{
    const merlin_stereo_method m = params->method;
    if (maps->captured) return fail(MERLIN_WRONG_USE, "these maps are of a captured surface, not of a photograph");
    if (m == MERLIN_STEREO_AUTO || m == MERLIN_STEREO_NEAR || m == MERLIN_STEREO_UNCALIBRATED) return OK;
    return fail(MERLIN_WRONG_USE, "a photograph is relit by near lights: its methods are auto, near and uncalibrated");
}

merlin_status merlin_stereo_from_maps(merlin_model *model, const merlin_maps *maps, const merlin_stereo_params *params,
                                      merlin_surface *out)
{
    static const merlin_stereo_params usual = {0};
    if (out) *out = (merlin_surface){0};
    status s = api_needs(__func__, model && maps && out);
    if (!params) params = &usual;
    if (s == OK) s = check(maps, params);
    if (s != OK) return s;
    work w = {.params = params, .watch = {params->progress, params->progress_context, params->stop}};
    s = make(model, maps, &w, out);
    for (int i = 0; i < w.solved; i++)
        img_free(&w.normals[i]);
    relit_free(&w.relit);
    if (s != OK) merlin_surface_free(out);
    return s;
}
