#include "render/render.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "optics/light.h"
#include "render/paths.h"
#include "render/smooth.h"
#include "render/streams.h"
#include "render/visibility.h"

/* What a layer's paths are drawn from. */
typedef struct layer_source {
    sequence sequence;
    rng random;
} layer_source;

typedef struct renderer {
    trace_scene *scene;
    const image_settings *settings;
    const environment *env;
    visibility *visibility;
    point_light flash, lights[SAMPLE_MAX_TARGETS];
    layer_source indirect, target, surroundings;
    sample *out;
} renderer;

/* What one pixel sees: the shaded points and the share of the pixel that the object covers. */
typedef struct pixel {
    int x, y, count;
    float coverage;
    scn_surface at[VISIBILITY_MAX_POINTS];
    vec3 view[VISIBILITY_MAX_POINTS];
} pixel;

static void see_pixel(renderer *r, int x, int y, pixel *p)
{
    pixel_hits seen;
    visibility_pixel(r->visibility, x, y, &seen);
    p->x = x;
    p->y = y;
    p->coverage = seen.coverage;
    p->count = seen.count;
    for (int i = 0; i < seen.count; i++) {
        scn_surface *at = &p->at[i];
        p->view[i] = vec3_scale(seen.direction[i], -1);
        trace_surface_at(r->scene, &seen.hit[i], p->view[i], at);
        /* the stored normal must face the camera plane too; off the axis, facing the eye does not imply it */
        if (at->normal.z < 0.01f) at->normal = vec3_normalize(vec3_make(at->normal.x, at->normal.y, 0.01f));
    }
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

static vec3 mean_direct(renderer *r, const pixel *p, const point_light *light)
{
    vec3 sum = {0, 0, 0};
    for (int i = 0; i < p->count; i++)
        sum = vec3_add(sum, light->at_eye ? point_light_unshadowed(r->scene, &p->at[i], p->view[i], light)
                                          : point_light_direct(r->scene, &p->at[i], p->view[i], light));
    return vec3_scale(sum, p->coverage / (float)p->count);
}

static path_source source_of(layer_source *layer, const pixel *p, int paths)
{
    return (path_source){&layer->sequence, sequence_index(p->x, p->y) * (uint32_t)paths, &layer->random};
}

static void mean_indirect(renderer *r, const pixel *p, const point_light *light, layer_source *layer, vec3 bounce[2])
{
    int paths = r->settings->paths;
    path_source source = source_of(layer, p, paths);
    path_points points = {p->at, p->view, p->count};
    point_light_paths(r->scene, &points, light, &source, paths, bounce);
    for (int b = 0; b < 2; b++)
        bounce[b] = vec3_scale(bounce[b], p->coverage / (float)paths);
}

static vec3 mean_environment(renderer *r, const pixel *p)
{
    int paths = (5 * r->settings->paths + 7) / 8;
    path_source source = source_of(&r->surroundings, p, paths);
    path_points points = {p->at, p->view, p->count};
    vec3 sum = environment_paths(r->scene, &points, r->env, &source, paths);
    return vec3_scale(sum, p->coverage / (float)paths);
}

static void render_pixel(renderer *r, int x, int y)
{
    pixel p;
    vec3 bounce[2];
    see_pixel(r, x, y, &p);
    if (p.count == 0) return;
    store_maps(r, &p);
    store(&r->out->direct, &p, mean_direct(r, &p, &r->flash), 1);
    mean_indirect(r, &p, &r->flash, &r->indirect, bounce);
    store(&r->out->indirect, &p, vec3_add(bounce[0], bounce[1]), 1);
    if (r->settings->bounces) {
        store(&r->out->bounce2, &p, bounce[0], 1);
        store(&r->out->bounce3, &p, bounce[1], 1);
    }
    for (int t = 0; t < r->settings->targets; t++) {
        store(&r->out->targets[t].direct, &p, mean_direct(r, &p, &r->lights[t]), 1);
        mean_indirect(r, &p, &r->lights[t], &r->target, bounce);
        store(&r->out->targets[t].indirect, &p, vec3_add(bounce[0], bounce[1]), 1);
    }
    if (r->env) store(&r->out->env, &p, mean_environment(r, &p), 1);
}

/* ---- a sample -------------------------------------------------------------------------------------------------- */

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
    if (s != OK || set->targets == 0) return s;
    out->targets = calloc((size_t)set->targets, sizeof *out->targets);
    if (!out->targets) return fail(ERROR_MEMORY, "out of memory for %d target images", set->targets);
    out->target_count = set->targets;
    for (int t = 0; s == OK && t < set->targets; t++) {
        s = img_new(&out->targets[t].direct, set->size, set->size, 3);
        if (s == OK) s = img_new(&out->targets[t].indirect, set->size, set->size, 3);
    }
    return s;
}

/* The environment casts shadows and is filtered less than what other surfaces send. */
static status smooth_layers(sample *out)
{
    enum { INDIRECT_RADIUS = 3, ENVIRONMENT_RADIUS = 1 };
    status s = smooth_layer(out, &out->indirect, INDIRECT_RADIUS);
    if (s == OK && out->bounce2.data) s = smooth_layer(out, &out->bounce2, INDIRECT_RADIUS);
    if (s == OK && out->bounce3.data) s = smooth_layer(out, &out->bounce3, INDIRECT_RADIUS);
    if (s == OK && out->env.data) s = smooth_layer(out, &out->env, ENVIRONMENT_RADIUS);
    for (int t = 0; s == OK && t < out->target_count; t++)
        s = smooth_layer(out, &out->targets[t].indirect, INDIRECT_RADIUS);
    return s;
}

static layer_source layer_of(uint64_t seed, uint64_t index, int stream)
{
    layer_source layer = {.random = rng_at(seed, index, (uint64_t)stream)};
    layer.sequence = sequence_of(&layer.random);
    return layer;
}

status render_image(trace_scene *scene, const image_settings *settings, uint64_t seed, uint64_t index,
                    const environment *env, sample *out)
{
    *out = (sample){.light_power = LIGHT_POWER,
                    .fov = settings->fov,
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
                  .flash = {{0, 0, 0}, LIGHT_POWER, true},
                  .indirect = layer_of(seed, index, STREAM_INDIRECT),
                  .target = layer_of(seed, index, STREAM_TARGET),
                  .surroundings = layer_of(seed, index, STREAM_SURROUNDINGS),
                  .out = out};
    const camera eye = {settings->size, settings->size, settings->fov};
    rng jitter = rng_at(seed, index, STREAM_JITTER);
    uint64_t key = (uint64_t)rng_u32(&jitter) << 32;
    s = visibility_new(scene, &eye, settings->strata, key | rng_u32(&jitter), &r.visibility);
    if (s != OK) {
        sample_free(out);
        return s;
    }
    rng lights = rng_at(seed, index, STREAM_LIGHTS);
    for (int t = 0; t < settings->targets; t++) {
        float u1 = rng_uniform(&lights), u2 = rng_uniform(&lights);
        r.lights[t] = (point_light){frontal_light(u1, u2), LIGHT_POWER, false};
        out->targets[t].light = r.lights[t].position;
    }
    if (env) memcpy(out->sh, env->sh, sizeof out->sh);
    for (int y = 0; y < settings->size; y++)
        for (int x = 0; x < settings->size; x++)
            render_pixel(&r, x, y);
    visibility_free(r.visibility);
    s = smooth_layers(out);
    if (s != OK) sample_free(out);
    return s;
}
