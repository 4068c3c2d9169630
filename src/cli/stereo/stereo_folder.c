/* SPDX-License-Identifier: MIT */
#include "cli/stereo/stereo_folder.h"

#include <stdlib.h>

#include "base/json/json_put.h"
#include "base/progress.h"
#include "command/json_line.h"
#include "stereo/doubts/capture_doubts.h"
#include "stereo/integrate/surface_error.h"
#include "stereo/methods/place_lights.h"

static const float RESIDUAL_WHITE = 0.25f;

static void exchange(double *a, double *b)
{
    double old = *a;
    *a = *b;
    *b = old;
}

/* Returns the value of rank k, and partly sorts the values (Hoare's selection). */
static double of_rank(double *values, size_t count, size_t k)
{
    size_t low = 0, end = count;
    for (;;) {
        double pivot = values[low + (end - low) / 2];
        size_t less = low, more = end;
        for (size_t i = low; i < more;) {
            if (values[i] < pivot)
                exchange(&values[i++], &values[less++]);
            else if (values[i] > pivot)
                exchange(&values[i], &values[--more]);
            else
                i++;
        }
        if (k >= less && k < more) return pivot;
        low = k < less ? low : more;
        end = k < less ? less : end;
    }
}

/* Adds statistics; reorders the values. */
static void put_statistics(cJSON *report, const char *name, double *values, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += values[i];
    cJSON *o = json_put_object(report, name);
    json_put_number(o, "mean", count ? sum / (double)count : 0);
    json_put_number(o, "median", count ? of_rank(values, count, count / 2) : 0);
    json_put_number(o, "pixels", (double)count);
}

static size_t take_errors(const stereo_result *r, double *values)
{
    size_t count = 0, pixels = (size_t)r->mask.width * (size_t)r->mask.height;
    for (size_t i = 0; i < pixels; i++)
        if (r->mask.data[i] > 0.5f) values[count++] = (double)r->error.data[i];
    return count;
}

/* Collects angles to the true normals in degrees, where both are known. */
static size_t take_angles(const stereo_result *r, const img *truth, double *values)
{
    size_t count = 0, pixels = (size_t)r->mask.width * (size_t)r->mask.height;
    for (size_t i = 0; i < pixels; i++) {
        vec3 n = vec3_of(r->normal.data + 3 * i), t = vec3_of(truth->data + 3 * i);
        if (r->mask.data[i] <= 0.5f || !(vec3_dot(t, t) > (real)0.25)) continue;
        values[count++] = normal_angle(n, t);
    }
    return count;
}

/* Adds the lights, with positions in units of the camera's mean distance, which is 1 if unknown. */
static void put_lights(cJSON *report, const merlin_capture *c, const merlin_surface *s)
{
    const merlin_light *light = s->lights;
    cJSON *list = json_put_array(report, "lights_found");
    for (int i = 0; i < c->count; i++) {
        cJSON *o = json_append_object(list);
        json_put_text(o, "name", c->name[i]);
        json_put_item(o, "direction", cJSON_CreateFloatArray(light[i].direction, 3));
        if (s->lights_near) json_put_item(o, "position", cJSON_CreateFloatArray(light[i].position, 3));
        json_put_item(o, "intensity", cJSON_CreateFloatArray(light[i].intensity, c->channels));
    }
}

static status put_report(cJSON *report, const merlin_capture *c, const merlin_surface *s, const stereo_result *r)
{
    double *values = malloc((size_t)c->width * (size_t)c->height * sizeof *values);
    if (!values) return fail(MERLIN_NO_MEMORY, "no memory for a report");
    json_put_text(report, "method", pst_method_name(s->method));
    json_put_number(report, "pictures", c->count);
    json_put_number(report, "width", c->width);
    json_put_number(report, "height", c->height);
    json_put_number(report, "channels", c->channels);
    put_statistics(report, "residual", values, take_errors(r, values));
    if (c->normal_true.data)
        put_statistics(report, "normal_error_degrees", values, take_angles(r, &c->normal_true, values));
    if (c->lights_in_order) json_put_bool(report, "lights_in_order", true);
    if (s->lights) put_lights(report, c, s);
    if (s->method == MERLIN_STEREO_SEMI) json_put_bool(report, "strengths_unsure", s->strengths_unsure);
    if (s->method == MERLIN_STEREO_NEAR) json_put_bool(report, "distance_unsure", s->distance_unsure);
    if (s->method == MERLIN_STEREO_UNCALIBRATED) json_put_bool(report, "lights_unsure", s->lights_unsure);
    free(values);
    return OK;
}

/* Moves normal, depth and residual from the surface; a grey albedo becomes three channels. */
static status take_surface(const merlin_capture *c, merlin_surface *s, stereo_result *r)
{
    *r = (stereo_result){.error_name = "residual", .error_white = RESIDUAL_WHITE, .camera = c->camera};
    status result = img_copy(&r->mask, &c->mask);
    if (result == OK) result = img_new(&r->albedo, c->width, c->height, 3);
    if (result != OK) return result;
    size_t values = 3 * (size_t)c->width * (size_t)c->height, channels = (size_t)s->albedo.channels;
    for (size_t i = 0; i < values; i++)
        r->albedo.data[i] = s->albedo.data[i / 3 * channels + (channels == 3 ? i % 3 : 0)];
    r->normal = s->normal;
    r->depth = s->depth;
    r->error = s->residual;
    s->normal = s->depth = s->residual = (img){0};
    return OK;
}

static status solve(const stereo_folder *f, const merlin_capture *c, stereo_result *out, cJSON *report)
{
    merlin_surface surface;
    warnings doubts = {0};
    double began = clock_seconds();
    status s = pst_solve(c, &f->params, &surface);
    if (s != OK) return s;
    double solved = clock_seconds();
    s = pst_surface_integrate(&f->params, &surface);
    if (s == OK) s = pst_doubts(c, &surface, &doubts);
    if (s == OK) s = take_surface(c, &surface, out);
    if (s == OK) s = put_report(report, c, &surface, out);
    out->doubts = doubts;
    json_put_number(report, "seconds_solve", solved - began);
    json_put_number(report, "seconds_integrate", clock_seconds() - solved);
    merlin_surface_free(&surface);
    return s;
}

status stereo_from_folder(const stereo_folder *f, stereo_result *out, cJSON *report)
{
    *out = (stereo_result){0};
    merlin_capture c;
    double began = clock_seconds();
    status s = pst_capture_read(f->folder, &f->files, &c);
    if (s != OK) return s;
    json_put_number(report, "seconds_read", clock_seconds() - began);
    const watch shown = {f->params.progress, f->params.progress_context, f->params.stop};
    bool any = f->params.method == MERLIN_STEREO_AUTO || f->params.method == MERLIN_STEREO_NEAR;
    if (c.about_object && any) s = pst_place_lights(&c, &shown);
    if (s == OK) s = solve(f, &c, out, report);
    out->skipped = c.skipped;
    c.skipped = (skipped_files){0};
    pst_capture_free(&c);
    return s;
}
