/* SPDX-License-Identifier: MIT */
/* report.json: how a photograph was processed, and the maps' statistics. */
#include <cjson/cJSON.h>
#include <math.h>

#include "base/api_needs.h"
#include "base/json/json_put.h"
#include "base/text/report.h"
#include "estimate/files/maps_files.h"
#include "estimate/light/found_light.h"
#include "estimate/relight/maps_surface.h"
#include "estimate/surface/exposure.h"

typedef struct range {
    double low, high, sum;
    size_t count;
} range;

static void add(range *r, double x)
{
    if (r->count == 0 || x < r->low) r->low = x;
    if (r->count == 0 || x > r->high) r->high = x;
    r->sum += x;
    r->count++;
}

/* Returns the range of one channel of a map over the object's pixels. */
static range range_of(const merlin_maps *maps, const merlin_image *map, int channel)
{
    range r = {0};
    size_t count = (size_t)map->width * (size_t)map->height;
    for (size_t i = 0; i < count; i++)
        if (maps->mask.data[i] >= 0.5f) add(&r, map->data[i * (size_t)map->channels + (size_t)channel]);
    return r;
}

static double mean(const range *r)
{
    return r->count ? r->sum / (double)r->count : 0;
}

static void put_range(cJSON *to, const char *name, const range *r)
{
    cJSON *o = json_put_object(to, name);
    json_put_number(o, "min", r->low);
    json_put_number(o, "mean", mean(r));
    json_put_number(o, "max", r->high);
}

static void put_statistics(cJSON *root, const merlin_maps *maps)
{
    cJSON *o = json_put_object(root, "statistics");
    cJSON *albedo = json_put_array(o, "albedo_mean");
    range roughness = range_of(maps, &maps->roughness, 0), depth = range_of(maps, &maps->depth, 0);
    for (int c = 0; c < 3; c++) {
        range r = range_of(maps, &maps->albedo, c);
        json_append(albedo, cJSON_CreateNumber(mean(&r)));
    }
    put_range(o, "roughness", &roughness);
    put_range(o, "depth", &depth);
    if (maps->spread.data) {
        const range spread = range_of(maps, &maps->spread, 0);
        put_range(o, "normal_spread", &spread);
    }
    json_put_number(o, "object_pixels", (double)depth.count);
}

static void put_reconstruction_error(cJSON *root, const merlin_maps *maps)
{
    if (!maps->reconstruction.data) return;
    range r = {0};
    img photo = maps->photo;
    float scale = maps->gain / exposure_white(&photo, maps->gain);
    size_t count = (size_t)maps->mask.width * (size_t)maps->mask.height;
    for (size_t i = 0; i < 3 * count; i++) {
        if (maps->mask.data[i / 3] < 0.5f) continue;
        double seen = fmin(scale * photo.data[i], 1), made = maps->reconstruction.data[i];
        add(&r, (seen - made) * (seen - made));
    }
    json_put_number(root, "reconstruction_rmse", sqrt(mean(&r)));
}

static void put_timing(cJSON *root, const merlin_timing *t)
{
    cJSON *o = json_put_object(root, "seconds");
    json_put_number(o, "mask", t->mask);
    json_put_number(o, "compile", t->compile);
    json_put_number(o, "prepare", t->prepare);
    json_put_number(o, "choose", t->choose);
    json_put_number(o, "network", t->network);
    json_put_number(o, "upsample", t->upsample);
}

/* Adds nine coefficients of three channels. */
static void put_environment(cJSON *root, const merlin_maps *maps)
{
    if (!maps->has_environment) return;
    cJSON *all = json_put_array(root, "environment");
    for (int i = 0; i < 9; i++) {
        cJSON *channels = cJSON_CreateArray();
        for (int c = 0; c < 3; c++)
            json_append(channels, cJSON_CreateNumber((double)maps->environment[i][c]));
        json_append(all, channels);
    }
}

/* Adds the lens of the crop, and the position of its axis. */
static void put_lens(cJSON *root, const merlin_maps *maps)
{
    json_put_text(root, "lens", maps->fov > 0 ? "known" : "assumed");
    json_put_number(root, "field_of_view", maps->fov > 0 ? (double)maps->fov : (double)CAMERA_FOV);
    cJSON *slant = json_put_array(root, "slant");
    for (int i = 0; i < 2; i++)
        json_append(slant, cJSON_CreateNumber((double)maps->slant[i]));
}

static void put_numbers(cJSON *to, const char *name, const float *values, int count)
{
    cJSON *all = json_put_array(to, name);
    for (int i = 0; i < count; i++)
        json_append(all, cJSON_CreateNumber((double)values[i]));
}

/* Adds the light that a model of any light estimated. */
static void put_light(cJSON *root, const merlin_found_light *l)
{
    char words[MERLIN_LIGHT_WORDS];
    if (!l->known) return;
    cJSON *light = json_put_object(root, "light");
    const found_light_shares share = found_light_share(l);
    merlin_light_words(l, words, sizeof words);
    json_put_text(light, "words", words);
    put_numbers(light, "shares", (const float[]){share.flash, share.lamp, share.rest}, 3);
    json_put_number(light, "flash", (double)l->flash);
    json_put_number(light, "lamp_sure", (double)l->lamp_sure);
    if (l->lamp[0] != 0 || l->lamp[1] != 0 || l->lamp[2] != 0) {
        put_numbers(light, "lamp", l->lamp, 3);
        json_put_number(light, "lamp_distance", (double)l->lamp_distance);
        put_numbers(light, "lamp_strength", l->lamp_strength, 3);
    }
    put_numbers(light, "rest", &l->rest[0][0], 27);
}

/* Adds the lamp that a further photograph should have. */
static void put_further_light(cJSON *root, const float direction[3])
{
    char words[MERLIN_LIGHT_WORDS];
    if (direction[0] == 0 && direction[1] == 0 && direction[2] == 0) return;
    cJSON *light = json_put_object(root, "further_light");
    merlin_lamp_words(direction, words, sizeof words);
    json_put_text(light, "words", words);
    put_numbers(light, "direction", direction, 3);
}

/* Tells whether the scale of albedo is known. A camera adapts a flash's strength to the distance, while an object's
 * brightness does not reveal the strength of other light. */
static bool is_scale_known(const merlin_maps *maps)
{
    return !maps->light.known || found_light_share(&maps->light).flash >= 0.5f;
}

static char *compose(const merlin_maps *maps)
{
    warnings doubts;
    merlin_maps_warnings(maps, &doubts);
    cJSON *root = report_begin(&doubts);
    json_put_text(root, "model", maps->model);
    if (maps->photographs > 1) {
        json_put_number(root, "photographs", maps->photographs);
        json_put_bool(root, "refined", maps->refined != 0);
        put_further_light(root, maps->further_light);
    }
    json_put_number(root, "width", maps->albedo.width);
    json_put_number(root, "height", maps->albedo.height);
    cJSON *square = json_put_object(root, "crop");
    json_put_number(square, "x", maps->crop.x);
    json_put_number(square, "y", maps->crop.y);
    json_put_number(square, "side", maps->crop.side);
    json_put_number(root, "network_size", maps->size);
    json_put_number(root, "exposure_gain", maps->gain);
    json_put_number(root, "burnt_out", maps->burnt_out);
    json_put_text(root, "mask", maps->mask_source == MERLIN_MASK_FOUND ? "found" : "given");
    json_put_number(root, "mask_confidence", maps->mask_confidence);
    json_put_number(root, "light_elsewhere", maps->light_elsewhere);
    put_lens(root, maps);
    put_light(root, &maps->light);
    json_put_text(root, "albedo_scale", is_scale_known(maps) ? "known" : "unsure");
    put_environment(root, maps);
    put_statistics(root, maps);
    put_reconstruction_error(root, maps);
    put_timing(root, &maps->timing);
    char *text = json_print(root);
    cJSON_Delete(root);
    return text;
}

merlin_status merlin_maps_report(const merlin_maps *maps, char **text)
{
    if (text) *text = NULL;
    status s = api_needs(__func__, maps && text);
    if (s == OK) s = maps_check(maps);
    if (s != OK) return s;
    *text = compose(maps);
    return *text ? OK : fail(MERLIN_NO_MEMORY, "no memory for a report");
}
