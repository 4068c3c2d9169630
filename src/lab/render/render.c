/* SPDX-License-Identifier: MIT */
#include "lab/render/render.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lab/render/layer_filter.h"
#include "lab/render/paths.h"
#include "lab/render/sample_lamps.h"
#include "lab/render/sample_targets.h"
#include "lab/render/streams.h"
#include "lab/render/visibility.h"
#include "optics/light.h"

/* The numbers from which a layer's paths are sampled. */
typedef struct layer_source {
    sequence sequence;
    rng random;
} layer_source;

/* The shaded points of one pixel, and its coverage by the object. */
typedef struct pixel {
    int x, y, count;
    float coverage;
    const scene_surface *at;
    const vec3 *view;
} pixel;

/* Adjacent pixels that see the object; together they fill the vectors, which single pixels would not. */
enum { STRIP = 16 };
typedef struct strip {
    int count, points;
    pixel pixel[STRIP];
    trace_hit hit[STRIP * VISIBILITY_MAX_POINTS];
    vec3 view[STRIP * VISIBILITY_MAX_POINTS];
    scene_surface at[STRIP * VISIBILITY_MAX_POINTS];
    /* by one point light, with and without shadows */
    vec3 radiance[STRIP * VISIBILITY_MAX_POINTS], unshadowed[STRIP * VISIBILITY_MAX_POINTS];
} strip;

typedef struct renderer {
    trace_scene *scene;
    const image_settings *settings;
    const environment *env;
    visibility *visibility;
    point_light flash, lights[SAMPLE_MAX_TARGETS], lamps[SAMPLE_MAX_LAMPS];
    layer_source indirect, target, led, lamp, surroundings;
    strip strip;
    sample *out;
} renderer;

static void see_pixel(renderer *r, int x, int y)
{
    strip *s = &r->strip;
    pixel_hits seen;
    visibility_pixel(r->visibility, x, y, &seen);
    if (seen.count == 0) return;
    s->pixel[s->count++] = (pixel){x, y, seen.count, seen.coverage, s->at + s->points, s->view + s->points};
    for (int i = 0; i < seen.count; i++) {
        s->hit[s->points] = seen.hit[i];
        s->view[s->points++] = vec3_scale(seen.direction[i], -1);
    }
}

static void see_strip(renderer *r, int first, int y)
{
    strip *s = &r->strip;
    s->count = s->points = 0;
    for (int x = first; x < first + STRIP && x < r->settings->size; x++)
        see_pixel(r, x, y);
    trace_surfaces_at(r->scene, s->hit, s->view, s->points, s->at);
    for (int i = 0; i < s->points; i++)
        s->at[i].normal = sample_normal(s->at[i].normal);
}

/* ---- layers ---------------------------------------------------------------------------------------------------- */

static void store(const img *image, const pixel *p, vec3 value, float scale)
{
    float *out = img_at(image, p->x, p->y);
    out[0] = value.x * scale;
    out[1] = value.y * scale;
    out[2] = value.z * scale;
}

static void store_maps(renderer *r, const pixel *p)
{
    vec3 albedo = {0, 0, 0}, normal = {0, 0, 0};
    float roughness = 0, depth = 0, share = 1 / (float)p->count;
    for (int i = 0; i < p->count; i++) {
        albedo = vec3_add(albedo, p->at[i].albedo);
        normal = vec3_add(normal, p->at[i].normal);
        roughness += p->at[i].roughness;
        depth -= p->at[i].position.z;
    }
    store(&r->out->albedo, p, albedo, share);
    store(&r->out->normal, p, vec3_normalize(normal), 1);
    *img_at(&r->out->roughness, p->x, p->y) = roughness * share;
    *img_at(&r->out->depth, p->x, p->y) = depth * share;
    *img_at(&r->out->mask, p->x, p->y) = p->coverage;
}

/* Averages the radiance of the strip's points into its pixels. */
static void store_radiance(const strip *s, const img *image)
{
    const vec3 *radiance = s->radiance;
    for (int k = 0; k < s->count; k++) {
        const pixel *p = &s->pixel[k];
        vec3 sum = {0, 0, 0};
        for (int i = 0; i < p->count; i++)
            sum = vec3_add(sum, *radiance++);
        store(image, p, sum, p->coverage / (float)p->count);
    }
}

static void store_direct(renderer *r, const point_light *light, const img *image)
{
    strip *s = &r->strip;
    if (light->at_eye)
        point_light_unshadowed(r->scene, s->at, s->view, s->points, light, s->radiance);
    else
        point_light_direct(r->scene, s->at, s->view, s->points, light, s->radiance);
    store_radiance(s, image);
}

static float sum_of(vec3 v)
{
    return v.x + v.y + v.z;
}

static void store_visibility(const strip *s, const img *image)
{
    const vec3 *arrived = s->radiance, *sent = s->unshadowed;
    for (int k = 0; k < s->count; k++) {
        const pixel *p = &s->pixel[k];
        float seen = 0, all = 0;
        for (int i = 0; i < p->count; i++) {
            seen += sum_of(*arrived++);
            all += sum_of(*sent++);
        }
        *img_at(image, p->x, p->y) = all > 0 ? seen / all : 0;
    }
}

/* Sets where the paths of the strip's pixels start. */
static void make_starts(const strip *s, int paths, path_points starts[STRIP])
{
    for (int i = 0; i < s->count; i++) {
        const pixel *p = &s->pixel[i];
        starts[i] = (path_points){p->at, p->view, p->count, sequence_index(p->x, p->y) * (uint32_t)paths};
    }
}

/* Stores indirect light; bounces: images of bounce 2 and of bounce 3, or NULL. */
static void store_indirect(renderer *r, const point_light *light, layer_source *layer, const img *both,
                           const img *const bounces[2])
{
    int paths = r->settings->paths;
    vec3 bounce[STRIP][2];
    path_points starts[STRIP];
    path_source source = {&layer->sequence, &layer->random};
    make_starts(&r->strip, paths, starts);
    point_light_paths(r->scene, starts, r->strip.count, light, &source, paths, bounce);
    for (int i = 0; i < r->strip.count; i++) {
        const pixel *p = &r->strip.pixel[i];
        float share = p->coverage / (float)paths;
        store(both, p, vec3_add(bounce[i][0], bounce[i][1]), share);
        for (int k = 0; bounces && k < 2; k++)
            store(bounces[k], p, bounce[i][k], share);
    }
}

static void store_lamp(renderer *r, int i)
{
    strip *s = &r->strip;
    const sample_lamp *under = &r->out->lamps[i];
    point_light_both(r->scene, s->at, s->view, s->points, &r->lamps[i], s->radiance, s->unshadowed);
    store_radiance(s, &under->direct);
    store_visibility(s, &under->visibility);
    point_light point = r->lamps[i]; /* for indirect light a disc differs little from a point */
    point.across[0] = point.across[1] = vec3_make(0, 0, 0);
    store_indirect(r, &point, &r->lamp, &under->indirect, NULL);
}

static void store_environment(renderer *r)
{
    int paths = (5 * r->settings->paths + 7) / 8;
    vec3 radiance[STRIP];
    path_points starts[STRIP];
    path_source source = {&r->surroundings.sequence, &r->surroundings.random};
    make_starts(&r->strip, paths, starts);
    environment_paths(r->scene, starts, r->strip.count, r->env, &source, paths, radiance);
    for (int i = 0; i < r->strip.count; i++)
        store(&r->out->env, &r->strip.pixel[i], radiance[i], r->strip.pixel[i].coverage / (float)paths);
}

static void render_strip(renderer *r, int first, int y)
{
    sample *out = r->out;
    const img *const bounces[2] = {&out->bounce2, &out->bounce3};
    see_strip(r, first, y);
    for (int i = 0; i < r->strip.count; i++)
        store_maps(r, &r->strip.pixel[i]);
    store_direct(r, &r->flash, &out->direct);
    store_indirect(r, &r->flash, &r->indirect, &out->indirect, r->settings->bounces ? bounces : NULL);
    for (int t = 0; t < out->target_count; t++) {
        layer_source *layer = t < r->settings->targets ? &r->target : &r->led;
        store_direct(r, &r->lights[t], &out->targets[t].direct);
        store_indirect(r, &r->lights[t], layer, &out->targets[t].indirect, NULL);
    }
    for (int i = 0; i < r->settings->lamps; i++)
        store_lamp(r, i);
    if (r->env) store_environment(r);
}

/* ---- a sample -------------------------------------------------------------------------------------------------- */

static status make_lamps(const image_settings *set, sample *out)
{
    if (set->lamps == 0) return OK;
    out->lamps = calloc((size_t)set->lamps, sizeof *out->lamps);
    if (!out->lamps) return fail(MERLIN_NO_MEMORY, "out of memory for images under %d lamps", set->lamps);
    out->lamp_count = set->lamps;
    status s = OK;
    for (int i = 0; s == OK && i < set->lamps; i++) {
        sample_lamp *under = &out->lamps[i];
        s = img_new(&under->direct, set->size, set->size, 3);
        if (s == OK) s = img_new(&under->indirect, set->size, set->size, 3);
        if (s == OK) s = img_new(&under->visibility, set->size, set->size, 1);
    }
    return s;
}

static status make_targets(const image_settings *set, sample *out)
{
    const int count = set->targets + set->leds;
    if (count == 0) return OK;
    out->targets = calloc((size_t)count, sizeof *out->targets);
    if (!out->targets) return fail(MERLIN_NO_MEMORY, "out of memory for %d target images", count);
    out->target_count = count;
    status s = OK;
    for (int t = 0; s == OK && t < count; t++) {
        s = img_new(&out->targets[t].direct, set->size, set->size, 3);
        if (s == OK) s = img_new(&out->targets[t].indirect, set->size, set->size, 3);
    }
    return s;
}

static status make_layers(const image_settings *set, bool env, sample *out)
{
    struct {
        img *image;
        int channels;
        bool wanted;
    } layers[] = {{&out->albedo, 3, true},
                  {&out->normal, 3, true},
                  {&out->roughness, 1, true},
                  {&out->depth, 1, true},
                  {&out->mask, 1, true},
                  {&out->direct, 3, true},
                  {&out->indirect, 3, true},
                  {&out->bounce2, 3, set->bounces},
                  {&out->bounce3, 3, set->bounces},
                  {&out->env, 3, env}};
    status s = OK;
    for (size_t i = 0; s == OK && i < sizeof layers / sizeof *layers; i++)
        if (layers[i].wanted) s = img_new(layers[i].image, set->size, set->size, layers[i].channels);
    if (s == OK) s = make_lamps(set, out);
    return s == OK ? make_targets(set, out) : s;
}

/* Filters the layers; the environment casts shadows, and is filtered less than indirect light. */
static status filter_layers(sample *out)
{
    enum { INDIRECT_RADIUS = 3, ENVIRONMENT_RADIUS = 1 };
    status s = filter_layer(out, &out->indirect, INDIRECT_RADIUS);
    if (s == OK && out->bounce2.data) s = filter_layer(out, &out->bounce2, INDIRECT_RADIUS);
    if (s == OK && out->bounce3.data) s = filter_layer(out, &out->bounce3, INDIRECT_RADIUS);
    if (s == OK && out->env.data) s = filter_layer(out, &out->env, ENVIRONMENT_RADIUS);
    for (int t = 0; s == OK && t < out->target_count; t++)
        s = filter_layer(out, &out->targets[t].indirect, INDIRECT_RADIUS);
    for (int i = 0; s == OK && i < out->lamp_count; i++)
        s = filter_layer(out, &out->lamps[i].indirect, INDIRECT_RADIUS);
    return s;
}

static layer_source layer_of(uint64_t seed, uint64_t index, int stream)
{
    layer_source layer = {.random = rng_at(seed, index, (uint64_t)stream)};
    layer.sequence = sequence_of(&layer.random);
    return layer;
}

static void place_targets(renderer *r, uint64_t seed, uint64_t index)
{
    rng lights = rng_at(seed, index, STREAM_LIGHTS), leds = rng_at(seed, index, STREAM_LED_PLACES);
    for (int t = 0; t < r->out->target_count; t++) {
        sample_target *under = &r->out->targets[t];
        if (t < r->settings->targets)
            sample_target_draw(&lights, under);
        else
            sample_target_draw_led(&leds, under);
        r->lights[t] = sample_target_light(under);
    }
}

static void place_lamps(renderer *r, uint64_t seed, uint64_t index)
{
    rng lamps = rng_at(seed, index, STREAM_LAMP_PLACES);
    for (int i = 0; i < r->settings->lamps; i++) {
        sample_lamp *under = &r->out->lamps[i];
        if (r->settings->lamp_angles > 0)
            sample_lamp_draw_at(&lamps, r->settings->lamp_angle[i], under);
        else
            sample_lamp_draw(&lamps, r->scene->object, under);
        r->lamps[i] = sample_lamp_light(under);
    }
}

status render_image(trace_scene *scene, const image_settings *settings, uint64_t seed, uint64_t index,
                    const environment *env, sample *out)
{
    *out = (sample){.light_power = LIGHT_POWER,
                    .fov = settings->fov,
                    .slant = settings->slant,
                    .seed = seed,
                    .index = index,
                    .generator_version = SAMPLE_GENERATOR_VERSION};
    snprintf(out->shape, sizeof out->shape, "%s", scene->object->shape);
    status s = make_layers(settings, env != NULL, out);
    if (s != OK) {
        sample_free(out);
        return s;
    }
    renderer r = {.scene = scene,
                  .settings = settings,
                  .env = env,
                  .flash = {.power = LIGHT_POWER, .at_eye = true},
                  .indirect = layer_of(seed, index, STREAM_INDIRECT),
                  .target = layer_of(seed, index, STREAM_TARGET),
                  .led = layer_of(seed, index, STREAM_LEDS),
                  .lamp = layer_of(seed, index, STREAM_LAMPS),
                  .surroundings = layer_of(seed, index, STREAM_SURROUNDINGS),
                  .out = out};
    const camera eye = {settings->size, settings->size, settings->fov, settings->slant};
    rng jitter = rng_at(seed, index, STREAM_JITTER);
    uint64_t key = (uint64_t)rng_u32(&jitter) << 32;
    s = visibility_new(scene, &eye, settings->strata, key | rng_u32(&jitter), &r.visibility);
    if (s != OK) {
        sample_free(out);
        return s;
    }
    place_targets(&r, seed, index);
    place_lamps(&r, seed, index);
    if (env) memcpy(out->sh, env->sh, sizeof out->sh);
    for (int y = 0; y < settings->size; y++)
        for (int x = 0; x < settings->size; x += STRIP)
            render_strip(&r, x, y);
    visibility_free(r.visibility);
    s = filter_layers(out);
    if (s != OK) sample_free(out);
    return s;
}
