/* SPDX-License-Identifier: MIT */
/* merlin_surface_report: what is known of a surface, as report.json has it (docs/json.md). */
#include "base/api_needs.h"
#include "base/json/json_put.h"
#include "base/skipped.h"
#include "base/text/report.h"
#include "stereo/fit/albedo_scale.h"
#include "stereo/integrate/stereo_surface.h"
#include "stereo/integrate/surface_statistics.h"
#include "surfaces/error_map.h"

static void put_statistics(cJSON *report, const char *name, const merlin_statistics *s)
{
    cJSON *o = json_put_object(report, name);
    json_put_number(o, "mean", s->mean);
    json_put_number(o, "median", s->median);
    json_put_number(o, "pixels", (double)s->count);
}

/* Lists positions in the unit of the camera's mean distance, which is 1 if unknown. */
static void put_lights(cJSON *report, const merlin_surface *s)
{
    cJSON *list = json_put_array(report, "lights_found");
    for (int i = 0; i < s->light_count; i++) {
        const merlin_light *light = &s->lights[i];
        cJSON *o = json_append_object(list);
        if (s->picture_names && i < s->picture_count) json_put_text(o, "name", s->picture_names[i]);
        json_put_item(o, "direction", cJSON_CreateFloatArray(light->direction, 3));
        if (s->lights_near) json_put_item(o, "position", cJSON_CreateFloatArray(light->position, 3));
        json_put_item(o, "intensity", cJSON_CreateFloatArray(light->intensity, s->albedo.channels));
    }
}

/* Statistics of maps. */
typedef struct figures {
    merlin_statistics residual, spread;
} figures;

static void put_captured(cJSON *report, const merlin_surface *s, const figures *of)
{
    json_put_number(report, "seconds_read", s->seconds.read);
    json_put_text(report, "method", merlin_stereo_method_name(s->method));
    json_put_number(report, "pictures", s->picture_count);
    json_put_number(report, "width", s->mask.width);
    json_put_number(report, "height", s->mask.height);
    json_put_number(report, "channels", s->albedo.channels);
    put_statistics(report, "residual", &of->residual);
    if (s->spread.data) put_statistics(report, "normal_spread_degrees", &of->spread);
    if (s->normal_error.count) put_statistics(report, "normal_error_degrees", &s->normal_error);
    if (s->lights_in_order) json_put_bool(report, "lights_in_order", true);
    if (s->lights) put_lights(report, s);
    if (s->method == MERLIN_STEREO_SEMI) json_put_bool(report, "strengths_unsure", s->strengths_unsure);
    if (s->method == MERLIN_STEREO_NEAR) json_put_bool(report, "distance_unsure", s->distance_unsure);
    if (s->method == MERLIN_STEREO_NEAR) json_put_bool(report, "by_network", s->by_network);
    if (s->method == MERLIN_STEREO_UNCALIBRATED) json_put_bool(report, "lights_unsure", s->lights_unsure);
    json_put_number(report, "seconds_solve", s->seconds.solve);
    json_put_number(report, "seconds_integrate", s->seconds.integrate);
}

static void put_relit(cJSON *report, const merlin_relit_photo *r)
{
    json_put_text(report, "model", r->model);
    json_put_number(report, "lights", r->lights);
    json_put_number(report, "draws", r->subsets);
    json_put_number(report, "lights_a_draw", r->lights_a_subset);
    json_put_number(report, "object_pixels", (double)r->pixels);
    json_put_number(report, "normal_spread_mean_degrees", r->spread);
    json_put_number(report, "angle_to_network_normal_mean_degrees", r->angle);
    json_put_number(report, "pixels_left_to_the_network", (double)r->pixels_left);
}

static void put_warnings(cJSON *report, const char *input, const merlin_surface *s)
{
    warnings all = s->warnings;
    skipped_warn(&s->skipped, &all);
    json_put_item(report, "warnings", warnings_json(&all));
    if (s->skipped.count) skipped_json(&s->skipped, input ? input : ".", json_put_array(report, "skipped"));
}

static char *compose(const merlin_surface *s, const char *input, const figures *of, float albedo_scale)
{
    cJSON *report = report_begin(NULL);
    if (input) json_put_text(report, "input", input);
    if (s->relit.lights)
        put_relit(report, &s->relit);
    else
        put_captured(report, s, of);
    json_put_number(report, "albedo_scale", (double)albedo_scale);
    json_put_text(report, "error_map", error_map_name(s));
    json_put_number(report, "error_map_white", (double)error_map_white(s));
    json_put_text(report, "integration", s->keep_edges ? "edges" : "ls");
    put_warnings(report, input, s);
    json_put_number(report, "seconds_total", s->seconds.total);
    char *text = json_print(report);
    cJSON_Delete(report);
    return text;
}

merlin_status merlin_surface_report(const merlin_surface *surface, const char *input, char **text)
{
    float scale = 1;
    figures of;
    if (text) *text = NULL;
    status s = api_needs(__func__, surface && text);
    if (s == OK) s = pst_surface_check(surface);
    if (s == OK) s = pst_albedo_scale(&surface->albedo, &surface->mask, &scale);
    if (s == OK) s = surface_statistics(surface, &surface->residual, &of.residual);
    if (s == OK) s = surface_statistics(surface, &surface->spread, &of.spread);
    if (s != OK) return s;
    *text = compose(surface, input, &of, scale);
    return *text ? OK : fail(MERLIN_NO_MEMORY, "no memory for a report");
}
