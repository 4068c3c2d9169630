/* SPDX-License-Identifier: MIT */
#include "cli/stereo/stereo_photo.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/json/json_put.h"
#include "command/photo_ahead.h"
#include "estimate/photo/photo_doubts.h"
#include "photo_stereo/draws.h"
#include "photo_stereo/relit.h"
#include "stereo/integrate/integrate.h"
#include "stereo/integrate/surface_error.h"

enum { LARGEST_SIDE = 512 };
static const float SPREAD_WHITE = 20;

/* The relit pictures, and sums over the draws. */
typedef struct work {
    const stereo_photo *photo;
    merlin_model *model;
    merlin_maps maps;
    relit relit;
    img normals[DRAW_MOST];
    int draws;
} work;

static status open_photo(work *w)
{
    const stereo_photo *p = w->photo;
    status s = photo_open_models(p->weights, p->flash, &w->model);
    if (s == OK && file_is_folder(p->photo))
        s = merlin_maps_read(p->photo, &w->maps);
    else if (s == OK)
        s = photo_maps(w->model, p->photo, p->mask, &p->params, &w->maps);
    if (s != OK) return s;
    int side = w->maps.crop.side < LARGEST_SIDE ? w->maps.crop.side : LARGEST_SIDE;
    return relit_new(w->model, &w->maps, side, p->params.stop, &w->relit);
}

/* ---- draws ---- */

static status solve_draw(work *w, int draw)
{
    merlin_surface found;
    status s = draw_solve(&w->relit.capture, draw, w->photo->method, &found);
    if (s != OK) return s;
    w->normals[w->draws++] = found.normal;
    found.normal = (img){0};
    merlin_surface_free(&found);
    return OK;
}

static status solve_all(work *w)
{
    int (*stop)(void) = w->photo->params.stop;
    status s = OK;
    for (int d = 0; d < DRAW_MOST && s == OK; d++) {
        watch_tell(w->photo->watch, "solving", (double)d / DRAW_MOST);
        s = stop && stop() ? fail(MERLIN_STOPPED, "stopped") : solve_draw(w, d);
    }
    if (s == OK) watch_tell(w->photo->watch, "solving", 1);
    return s;
}

/* ---- mean and spread ---- */

static vec3 normal_at(const img *normal, size_t pixel)
{
    return vec3_of(normal->data + 3 * pixel);
}

/* Averages one pixel; returns the root mean square angle of the draws to their mean, in degrees. */
static float average(const work *w, size_t pixel, float *mean)
{
    vec3 sum = {0, 0, 0};
    for (int d = 0; d < DRAW_MOST; d++)
        sum = vec3_add(sum, normal_at(&w->normals[d], pixel));
    sum = vec3_normalize(sum);
    vec3_put(sum, mean);
    float square = 0;
    for (int d = 0; d < DRAW_MOST; d++) {
        float a = (float)normal_angle(normal_at(&w->normals[d], pixel), sum);
        square += a * a / DRAW_MOST;
    }
    return sqrtf(square);
}

/* Uses the network's normals where the draws contradict each other, as at a silhouette that few lights reach. */
static bool believe_network(const work *w, size_t pixel, stereo_result *out)
{
    if (out->error.data[pixel] <= SPREAD_WHITE) return false;
    memcpy(out->normal.data + 3 * pixel, w->relit.maps.normal.data + 3 * pixel, 3 * sizeof(float));
    return true;
}

static void average_all(const work *w, stereo_result *out, cJSON *report)
{
    double spread = 0, off = 0, count = 0, left = 0;
    size_t pixels = (size_t)out->mask.width * (size_t)out->mask.height;
    for (size_t i = 0; i < pixels; i++) {
        if (out->mask.data[i] <= 0.5f) continue;
        out->error.data[i] = average(w, i, out->normal.data + 3 * i);
        spread += (double)out->error.data[i];
        off += normal_angle(normal_at(&out->normal, i), normal_at(&w->relit.maps.normal, i));
        left += believe_network(w, i, out);
        count++;
    }
    json_put_text(report, "model", merlin_model_name(w->model));
    json_put_number(report, "lights", RELIT_LIGHTS);
    json_put_number(report, "draws", DRAW_MOST);
    json_put_number(report, "lights_a_draw", DRAW_PICTURES);
    json_put_number(report, "object_pixels", count);
    json_put_number(report, "normal_spread_mean_degrees", count > 0 ? spread / count : 0);
    json_put_number(report, "angle_to_network_normal_mean_degrees", count > 0 ? off / count : 0);
    json_put_number(report, "pixels_left_to_the_network", left);
}

static status result_new(work *w, stereo_result *out)
{
    int side = w->relit.capture.width;
    *out = (stereo_result){
        .error_name = "spread of the normals", .error_white = SPREAD_WHITE, .camera = w->relit.capture.camera};
    status s = img_copy(&out->mask, &w->relit.capture.mask);
    if (s == OK) s = img_new(&out->normal, side, side, 3);
    /* the pictures were rendered from it: a solver could only blur it with highlights */
    if (s == OK) s = img_copy(&out->albedo, &w->relit.maps.albedo);
    if (s == OK) s = img_new(&out->error, side, side, 1);
    return s;
}

static void work_free(work *w)
{
    for (int d = 0; d < w->draws; d++)
        img_free(&w->normals[d]);
    relit_free(&w->relit);
    merlin_maps_free(&w->maps);
    merlin_model_close(w->model);
}

status stereo_from_photo(const stereo_photo *p, stereo_result *out, cJSON *report)
{
    work w = {.photo = p};
    *out = (stereo_result){0};
    watch_tell(p->watch, "relighting", 0);
    status s = open_photo(&w);
    if (s == OK) s = result_new(&w, out);
    if (s == OK) doubts_list(&w.maps, &out->doubts);
    if (s == OK) s = solve_all(&w);
    if (s == OK) {
        average_all(&w, out, report);
        pst_integration how = {.preserve_edges = p->preserve_edges, .watch = p->watch};
        watch_tell(p->watch, "integrating", 0);
        s = pst_integrate(&out->normal, &out->mask, &out->camera, &how, &out->depth);
    }
    work_free(&w);
    return s;
}
