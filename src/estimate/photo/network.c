/* SPDX-License-Identifier: MIT */
#include <malloc.h>
#include <stdlib.h>
#include <string.h>

#include "base/progress.h"
#include "estimate/photo/network.h"
#include "estimate/photo/network_parts.h"
#include "estimate/photo/view.h"
#include "estimate/surface/fuse.h"
#include "estimate/surface/smooth.h"
#include "optics/orientation.h"

/* Outputs of each program; the rest of the whole network is left out of it. */
static const char *const single_outputs[] = {"albedo",           "normal", "roughness",  "depth", "indirect",
                                             "environment_code", "lights", "visibility", NULL};
static const char *const normal_outputs[] = {"normal", NULL};
static const char *const light_outputs[] = {"lights", NULL};

/* Checks that the configuration is still what it was when the file was opened, as callers know it already. */
static status check_config(const network *n, const model_config *now)
{
    char *one = model_config_write(now), *other = model_config_write(&n->config);
    status s = OK;
    if (!one || !other)
        s = fail(MERLIN_NO_MEMORY, "no memory to read %s", n->weights);
    else if (strcmp(one, other) != 0)
        s = fail(MERLIN_BAD_INPUT, "%s was replaced by other weights since it was opened", n->weights);
    free(one);
    free(other);
    return s;
}

static status load_params(network *n)
{
    model_config now;
    status s = model_load(n->weights, &now, &n->params);
    if (s == OK) s = check_config(n, &now);
    if (s == OK) return OK;
    nn_params_free(n->params);
    n->params = NULL;
    return s;
}

static status open_later(const char *weights, network **out)
{
    *out = NULL;
    network *n = calloc(1, sizeof *n);
    if (!n) return fail(MERLIN_NO_MEMORY, "no memory for a model");
    if (pthread_mutex_init(&n->lock, NULL) != 0) {
        free(n);
        return fail(MERLIN_NO_MEMORY, "no memory for a lock");
    }
    n->type = nn_fastest_type();
    n->weights = strdup(weights);
    status s = n->weights ? model_load_config(weights, &n->config) : fail(MERLIN_NO_MEMORY, "no memory for a model");
    if (s == OK && n->config.nfps_width)
        s = fail(MERLIN_BAD_INPUT,
                 "%s: model \"%s\" is for pictures under known lights, and makes no maps of photographs", weights,
                 n->config.name);
    if (s != OK)
        network_close(n);
    else
        *out = n;
    return s;
}

/* Closes a network that is of no use. */
static status keep_if(status s, network **n)
{
    if (s == OK) return OK;
    network_close(*n);
    *n = NULL;
    return s;
}

status network_open_later(const char *weights, network **out)
{
    status s = open_later(weights, out);
    if (s == OK && (*out)->config.only_lights)
        s = fail(MERLIN_BAD_INPUT, "%s: model \"%s\" tells only the lights of several photographs, and makes no maps",
                 weights, (*out)->config.name);
    return keep_if(s, out);
}

status network_open(const char *weights, network **out)
{
    status s = network_open_later(weights, out);
    if (s == OK) s = load_params(*out);
    return keep_if(s, out);
}

status network_open_several(const char *weights, network **out)
{
    status s = open_later(weights, out);
    if (s == OK && !(*out)->config.several)
        s = fail(MERLIN_WRONG_USE, "%s: model \"%s\" sees one photograph at a time", weights, (*out)->config.name);
    return keep_if(s, out);
}

static void compiled_free(compiled *c)
{
    nn_program_free(c->program);
    nn_graph_free(c->graph);
    *c = (compiled){0};
}

static void free_maps(network *n)
{
    compiled_free(&n->lights);
    compiled_free(&n->maps);
    compiled_free(&n->normals);
}

static void free_programs(network *n)
{
    free_maps(n);
    compiled_free(&n->features);
    compiled_free(&n->relit);
    compiled_free(&n->indirect);
}

void network_release(network *n)
{
    pthread_mutex_lock(&n->lock);
    free_programs(n);
    pthread_mutex_unlock(&n->lock);
    malloc_trim(0);
}

void network_release_maps(network *n)
{
    pthread_mutex_lock(&n->lock);
    free_maps(n);
    pthread_mutex_unlock(&n->lock);
    malloc_trim(0);
}

void network_compute_in(network *n, nn_type type)
{
    network_release(n);
    n->type = type;
}

void network_close(network *n)
{
    if (!n) return;
    free_programs(n);
    nn_params_free(n->params);
    pthread_mutex_destroy(&n->lock);
    free(n->weights);
    free(n);
    malloc_trim(0); /* the C library keeps freed memory otherwise */
}

const model_config *network_config(const network *n)
{
    return &n->config;
}

/* Returns the program with the largest memory. All programs share it, as inputs are written before every run and
 * outputs read after it. */
static const nn_program *largest(const network *n)
{
    const nn_program *all[] = {n->lights.program,   n->maps.program,  n->normals.program,
                               n->features.program, n->relit.program, n->indirect.program};
    const nn_program *found = NULL;
    size_t most = 0;
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        size_t bytes = all[i] ? nn_program_cost(all[i]).activation_bytes : 0;
        if (bytes > most) most = bytes, found = all[i];
    }
    return found;
}

static status compile(network *n, model_part part, const char *const *outputs, int size, int pictures, compiled *c)
{
    if (c->program && c->size == size && c->pictures == pictures && c->outputs == outputs) return OK;
    compiled_free(c);
    nn_options options = {.batch = pictures,
                          .group = pictures,
                          .height = size,
                          .width = size,
                          .type = n->type,
                          .purpose = NN_INFER,
                          .outputs = outputs,
                          .beside = largest(n)};
    double began = clock_seconds();
    status s = n->params ? OK : load_params(n);
    if (s == OK) s = model_build(&n->config, part, &c->graph);
    if (s == OK) s = nn_compile(c->graph, n->params, &options, &c->program);
    n->compile_seconds += clock_seconds() - began;
    if (s != OK)
        compiled_free(c);
    else
        c->size = size, c->pictures = pictures, c->outputs = outputs;
    return s;
}

status network_compile(network *n, model_part part, const char *const *outputs, int size, compiled *c)
{
    return compile(n, part, outputs, size, 1, c);
}

status network_compile_several(network *n, const char *const *outputs, int size, int pictures, compiled *c)
{
    return compile(n, MODEL_MAPS, outputs, size, pictures, c);
}

status network_prepare(network *n, int size, int views)
{
    pthread_mutex_lock(&n->lock);
    status s = network_compile(n, MODEL_MAPS, views == 1 ? single_outputs : view_outputs, size, &n->maps);
    pthread_mutex_unlock(&n->lock);
    return s;
}

status network_prepare_bounces(network *n, int size)
{
    if (!n->config.global_illumination) return OK;
    pthread_mutex_lock(&n->lock);
    status s = network_compile(n, MODEL_INDIRECT, NULL, size, &n->indirect);
    pthread_mutex_unlock(&n->lock);
    return s;
}

status network_prepare_lights(network *n, int size)
{
    pthread_mutex_lock(&n->lock);
    status s = network_compile(n, MODEL_MAPS, light_outputs, size, &n->lights);
    pthread_mutex_unlock(&n->lock);
    return s;
}

status network_prepare_normals(network *n, int size)
{
    pthread_mutex_lock(&n->lock);
    status s = network_compile(n, MODEL_MAPS, normal_outputs, size, &n->normals);
    pthread_mutex_unlock(&n->lock);
    return s;
}

double network_take_compile_seconds(network *n)
{
    pthread_mutex_lock(&n->lock);
    double seconds = n->compile_seconds;
    n->compile_seconds = 0;
    pthread_mutex_unlock(&n->lock);
    return seconds;
}

/* ---- between images and the program's buffers ---- */

/* Writes scale·x + shift into an input. */
static void put(nn_program *p, const char *name, const img *from, float scale, float shift)
{
    float *to = nn_input_data(p, name);
    if (!to) return;
    size_t count = img_value_count(from);
    for (size_t i = 0; i < count; i++)
        to[i] = scale * from->data[i] + shift;
}

status network_take(nn_program *p, const char *name, int size, int channels, float scale, float shift, img *out)
{
    const float *from = nn_output_data(p, name);
    if (!from) return fail(MERLIN_WRONG_USE, "this model has no output \"%s\"", name);
    status s = img_new(out, size, size, channels);
    if (s != OK) return s;
    size_t count = img_value_count(out);
    for (size_t i = 0; i < count; i++)
        out->data[i] = scale * from[i] + shift;
    return OK;
}

status network_run_view(network *n, const network_subject *at, int view, const char *const *outputs, compiled *c)
{
    const img *photo = at->photo, *mask = at->mask;
    status s = network_compile(n, MODEL_MAPS, outputs, photo->width, c);
    if (s != OK) return s;
    view_put(c->program, 0, view, photo, mask);
    view_put_shares(c->program, 1, photo->width);
    view_put_light(c->program, &n->config, 0, view, &(illumination){{0, 0, 0}, NULL});
    if (n->config.lighting == MODEL_LIGHT_ANY) view_put_sight(c->program, 0, view, at->how, photo->width);
    return nn_forward(c->program);
}

/* Reads the maps; albedo and roughness are in [-1, 1] in the network. */
static status take_maps(nn_program *p, int size, surface *maps)
{
    status s = network_take(p, "albedo", size, 3, 0.5f, 0.5f, &maps->albedo);
    if (s == OK) s = network_take(p, "normal", size, 3, 1, 0, &maps->normal);
    if (s == OK) s = network_take(p, "roughness", size, 1, 0.5f, 0.5f, &maps->roughness);
    if (s == OK) s = network_take(p, "depth", size, 1, 1, 0, &maps->depth);
    return s;
}

/* Reads the environment that a model of both lights estimates. */
static void take_environment(nn_program *p, float sh[9][3])
{
    const float *code = nn_output_data(p, "environment_code");
    if (code)
        model_decode_sh(code, sh);
    else
        memset(sh, 0, 9 * sizeof *sh);
}

status network_take_estimation(nn_program *p, int size, network_estimation *out)
{
    status s = take_maps(p, size, &out->maps);
    if (s == OK) take_environment(p, out->environment);
    const float *lights = nn_output_data(p, "lights");
    if (s != OK || !lights) return s;
    memcpy(out->lights, lights, sizeof out->lights);
    return network_take(p, "visibility", size, 1, 1, 0, &out->visibility);
}

/* Runs the network on the photograph in one orientation; the result has that orientation, too. */
static status estimate_view(network *n, const network_subject *at, int view, const char *const *outputs,
                            network_estimation *out)
{
    status s = network_run_view(n, at, view, outputs, &n->maps);
    return s == OK ? network_take_estimation(n->maps.program, at->photo->width, out) : s;
}

static status estimate_single(network *n, const network_subject *at, network_estimation *out)
{
    int size = at->photo->width;
    status s = estimate_view(n, at, 0, single_outputs, out);
    if (s != OK) return s;
    if (!n->config.global_illumination) return img_new(&out->indirect, size, size, 3);
    return network_take(n->maps.program, "indirect", size, 3, 1, 0, &out->indirect);
}

static status estimate_views(network *n, const network_subject *at, int views, int (*stop)(void),
                             network_estimation *out)
{
    if (views == 1) return estimate_single(n, at, out);
    status s = view_mean_new(&n->config, at->photo->width, out);
    for (int view = 0; view < views && s == OK; view++) {
        network_estimation turned = {0};
        if (stop && stop()) s = fail(MERLIN_STOPPED, "stopped");
        if (s == OK) s = estimate_view(n, at, view, view_outputs, &turned);
        if (s == OK) view_mean_add(out, &turned, view, 1.0f / (float)views);
        network_estimation_free(&turned);
    }
    return s;
}

static camera_lens lens_of(const sight *how)
{
    return how ? how->lens : (camera_lens){.fov = 0};
}

status network_finish(const network *n, surface *maps)
{
    sight_take_relief(maps->lens, &maps->mask, &maps->depth);
    if (n->config.lighting != MODEL_LIGHT_ANY) sight_turn_normals(maps->lens, &maps->mask, &maps->normal);
    status s = smooth_estimate(maps);
    if (s == OK) surface_tidy(maps);
    if (s == OK) s = fuse_depth(&maps->normal, &maps->mask, surface_lens(maps), &maps->depth);
    return s;
}

status network_check_views(int views)
{
    if (views >= 1 && views <= ORIENTATIONS) return OK;
    return fail(MERLIN_WRONG_USE, "a photograph has 1 to %d views, not %d", ORIENTATIONS, views);
}

status network_see(network *n, const img *photo, const img *mask, const sight *how, int views, int (*stop)(void),
                   network_estimation *out)
{
    const network_subject at = {photo, mask, how};
    *out = (network_estimation){0};
    status s = network_check_views(views);
    pthread_mutex_lock(&n->lock);
    if (s == OK) s = estimate_views(n, &at, views, stop, out);
    pthread_mutex_unlock(&n->lock);
    out->maps.lens = lens_of(how);
    img_free(&out->maps.mask);
    if (s == OK) s = img_copy(&out->maps.mask, mask);
    if (s != OK) network_estimation_free(out);
    return s;
}

status network_estimate(network *n, const img *photo, const img *mask, const sight *how, int views, int (*stop)(void),
                        network_estimation *out)
{
    status s = network_see(n, photo, mask, how, views, stop, out);
    if (s == OK) s = network_finish(n, &out->maps);
    if (s != OK) network_estimation_free(out);
    return s;
}

status network_lights(network *n, const img *photo, const img *mask, const sight *how, float lights[MODEL_LIGHTS])
{
    const network_subject at = {photo, mask, how};
    if (n->config.lighting != MODEL_LIGHT_ANY)
        return fail(MERLIN_WRONG_USE, "model \"%s\" does not tell what lights a photograph", n->config.name);
    pthread_mutex_lock(&n->lock);
    status s = network_run_view(n, &at, 0, light_outputs, &n->lights);
    if (s == OK) memcpy(lights, nn_output_data(n->lights.program, "lights"), MODEL_LIGHTS * sizeof *lights);
    pthread_mutex_unlock(&n->lock);
    return s;
}

static status add_normals(network *n, const network_subject *at, int view, float weight, img *mean)
{
    img turned = {0};
    status s = network_run_view(n, at, view, normal_outputs, &n->normals);
    if (s == OK) s = network_take(n->normals.program, "normal", at->photo->width, 3, 1, 0, &turned);
    if (s == OK) view_add_normals(mean, &turned, view, weight);
    img_free(&turned);
    return s;
}

status network_normals(network *n, const img *photo, const img *mask, const sight *how, int views, int (*stop)(void),
                       img *normal)
{
    const network_subject at = {photo, mask, how};
    *normal = (img){0};
    status s = network_check_views(views);
    if (s == OK) s = img_new(normal, photo->width, photo->height, 3);
    pthread_mutex_lock(&n->lock);
    for (int view = 0; view < views && s == OK; view++)
        s = stop && stop() ? fail(MERLIN_STOPPED, "stopped") : add_normals(n, &at, view, 1.0f / (float)views, normal);
    pthread_mutex_unlock(&n->lock);
    if (s == OK && n->config.lighting != MODEL_LIGHT_ANY) sight_turn_normals(lens_of(how), mask, normal);
    if (s == OK) s = smooth_inside(normal, mask);
    if (s == OK)
        surface_tidy_normals(mask, normal);
    else
        img_free(normal);
    return s;
}

void network_estimation_free(network_estimation *e)
{
    surface_free(&e->maps);
    img_free(&e->indirect);
    img_free(&e->spread);
    img_free(&e->visibility);
}

/* Clamps without a function call, so that loops are vectorized. */
static inline float between_0_and_1(float x)
{
    x = x > 0 ? x : 0;
    return x < 1 ? x : 1;
}

/* Writes direct light as in training: a lamp's is clipped to [0, 1]; an environment's is added separately for models
 * that know environments, and to the lamp's for others. */
static void put_direct(nn_program *p, const img *direct, const img *environment)
{
    float *to = nn_input_data(p, "direct"), *apart = nn_input_data(p, "environment");
    size_t count = img_value_count(direct);
    for (size_t i = 0; i < count; i++) {
        float more = environment ? environment->data[i] : 0;
        to[i] = apart ? between_0_and_1(direct->data[i]) + more : between_0_and_1(direct->data[i] + more);
        if (apart) apart[i] = more;
    }
}

static status run_indirect(network *n, const surface *maps, const img *direct, const img *environment, img *indirect)
{
    status s = network_compile(n, MODEL_INDIRECT, NULL, direct->width, &n->indirect);
    if (s != OK) return s;
    nn_program *p = n->indirect.program;
    put_direct(p, direct, environment);
    put(p, "albedo", &maps->albedo, 2, -1);
    put(p, "normal", &maps->normal, 1, 0);
    put(p, "roughness", &maps->roughness, 2, -1);
    put(p, "depth", &maps->depth, 1, 0);
    put(p, "mask", &maps->mask, 1, 0);
    s = nn_forward(p);
    return s == OK ? network_take(p, "indirect", direct->width, 3, 1, 0, indirect) : s;
}

status network_indirect(network *n, const surface *maps, const img *direct, const img *environment, img *indirect)
{
    *indirect = (img){0};
    if (!n->config.global_illumination) return img_new(indirect, direct->width, direct->height, 3);
    pthread_mutex_lock(&n->lock);
    status s = run_indirect(n, maps, direct, environment, indirect);
    pthread_mutex_unlock(&n->lock);
    return s;
}
