/* SPDX-License-Identifier: MIT */
/* Several photographs of an object in one network. */
#include <string.h>

#include "base/progress.h"
#include "estimate/photo/network.h"
#include "estimate/photo/network_parts.h"
#include "estimate/photo/view.h"

/* Photographs of an object, the same for all views. */
typedef struct pictures {
    const img *photos, *mask;
    int count;
    const sight *how;
} pictures;

static const char *const light_outputs[] = {"lights", NULL};

/* Runs the network on all photographs in one orientation. */
static status run_view(network *n, const pictures *of, int view, const char *const *outputs, compiled *c)
{
    const int size = of->mask->width;
    status s = network_compile_several(n, outputs, size, of->count, c);
    if (s != OK) return s;
    nn_program *p = c->program;
    for (int i = 0; i < of->count; i++) {
        view_put_photo(p, (size_t)i, view, &of->photos[i]);
        view_put_known(p, (size_t)i, view, of->how, size);
    }
    view_put_shares(p, of->count, size);
    view_put_mask(p, 0, view, of->mask);
    view_put_lens(p, 0, view, of->how);
    view_put_light(p, &n->config, 0, view, &(illumination){{0, 0, 0}, NULL});
    return nn_forward(p);
}

/* Adds what was found in one orientation to the mean. */
static status add_view(network *n, const pictures *of, int view, float weight, float (*lights)[MODEL_LIGHTS],
                       network_estimation *mean)
{
    network_estimation turned = {0};
    status s = run_view(n, of, view, view_outputs, &n->maps);
    if (s == OK) s = network_take_estimation(n->maps.program, of->mask->width, &turned);
    if (s == OK) view_mean_add(mean, &turned, view, weight);
    for (int i = 0; s == OK && lights && i < of->count; i++)
        view_add_lights(lights[i], nn_output_data(n->maps.program, "lights") + MODEL_LIGHTS * i, view, weight);
    network_estimation_free(&turned);
    return s;
}

static status see_all(network *n, const pictures *of, int views, int (*stop)(void), float (*lights)[MODEL_LIGHTS],
                      network_estimation *out)
{
    status s = view_mean_new(&n->config, of->mask->width, out);
    if (lights) memset(lights, 0, (size_t)of->count * sizeof *lights);
    for (int view = 0; view < views && s == OK; view++)
        s = stop && stop() ? fail(MERLIN_STOPPED, "stopped") : add_view(n, of, view, 1.0f / (float)views, lights, out);
    return s;
}

/* ---- the spread of normals ---- */

/* Normals from two halves of the photographs, not unit. */
typedef struct halves {
    img normal[2];
} halves;

static status halves_new(int size, halves *out)
{
    status s = OK;
    for (int half = 0; half < 2 && s == OK; half++)
        s = img_new(&out->normal[half], size, size, 3);
    return s;
}

static void halves_free(halves *h)
{
    for (int half = 0; half < 2; half++)
        img_free(&h->normal[half]);
}

/* Computes half the angle between them: the standard error of the mean of two. */
static status halves_spread(const halves *h, img *out)
{
    status s = img_new(out, h->normal[0].width, h->normal[0].height, 1);
    for (size_t i = 0; s == OK && i < img_value_count(out); i++) {
        const vec3 a = vec3_of(h->normal[0].data + 3 * i), b = vec3_of(h->normal[1].data + 3 * i);
        out->data[i] = 0.5f * (float)vec3_angle(a, b);
    }
    return s;
}

/* Sees every second photograph, and the others, in one orientation. An odd one is left out, so that both halves tell as
 * much. */
static status see_halves(network *n, const pictures *of, img *spread)
{
    halves h = {0};
    img photos[NN_LARGEST_GROUP];
    pictures some = *of;
    some.photos = photos;
    some.count = of->count / 2;
    status s = halves_new(of->mask->width, &h);
    for (int half = 0; half < 2 && s == OK; half++) {
        network_estimation seen = {0};
        for (int i = 0; i < some.count; i++)
            photos[i] = of->photos[2 * i + half];
        s = run_view(n, &some, 0, view_outputs, &n->maps);
        if (s == OK) s = network_take_estimation(n->maps.program, of->mask->width, &seen);
        if (s == OK) view_add_normals(&h.normal[half], &seen.maps.normal, 0, 1);
        network_estimation_free(&seen);
    }
    if (s == OK) s = halves_spread(&h, spread);
    halves_free(&h);
    return s;
}

/* Estimates each photograph alone, by a network of one, and averages the maps. */
static status see_each(network *n, const pictures *of, int views, int (*stop)(void), float (*lights)[MODEL_LIGHTS],
                       network_estimation *out)
{
    float first[MODEL_LIGHTS] = {0};
    halves h = {0};
    status s = view_mean_new(&n->config, of->mask->width, out);
    if (s == OK) s = halves_new(of->mask->width, &h);
    for (int i = 0; i < of->count && s == OK; i++) {
        network_estimation one = {0};
        s = network_see(n, &of->photos[i], of->mask, of->how, views, stop, &one);
        if (s == OK && lights) memcpy(lights[i], one.lights, sizeof lights[i]);
        if (s == OK) view_mean_add(out, &one, 0, 1.0f / (float)of->count);
        if (s == OK && i / 2 < of->count / 2) view_add_normals(&h.normal[i % 2], &one.maps.normal, 0, 1);
        if (i == 0) memcpy(first, one.lights, sizeof first);
        network_estimation_free(&one);
    }
    memcpy(out->lights, first, sizeof out->lights);
    if (s == OK && of->count > 1) s = halves_spread(&h, &out->spread);
    halves_free(&h);
    return s;
}

static status see_together(network *n, const pictures *of, int views, int (*stop)(void), float (*lights)[MODEL_LIGHTS],
                           network_estimation *out)
{
    pthread_mutex_lock(&n->lock);
    status s = see_all(n, of, views, stop, lights, out);
    pthread_mutex_unlock(&n->lock);
    return s;
}

static status check_count(int count)
{
    if (count >= 1 && count <= NN_LARGEST_GROUP) return OK;
    return fail(MERLIN_WRONG_USE, "%d photographs of an object: 1 to %d", count, NN_LARGEST_GROUP);
}

status network_estimate_several(network *n, const img *photos, int count, const img *mask, const sight *how, int views,
                                int (*stop)(void), float (*lights)[MODEL_LIGHTS], network_estimation *out)
{
    const pictures of = {photos, mask, count, how};
    *out = (network_estimation){0};
    status s = network_check_views(views);
    if (s == OK && n->config.lighting != MODEL_LIGHT_ANY)
        s = fail(MERLIN_WRONG_USE, "model \"%s\" is for flashes: several photographs have other lights",
                 n->config.name);
    if (s == OK) s = check_count(count);
    if (s == OK) s = (n->config.several ? see_together : see_each)(n, &of, views, stop, lights, out);
    out->maps.lens = how ? how->lens : (camera_lens){.fov = 0};
    img_free(&out->maps.mask);
    if (s == OK) s = img_copy(&out->maps.mask, mask);
    if (s == OK) s = network_finish(n, &out->maps);
    if (s != OK) network_estimation_free(out);
    return s;
}

status network_spread_several(network *n, const img *photos, int count, const img *mask, const sight *how, img *spread)
{
    const pictures of = {photos, mask, count, how};
    *spread = (img){0};
    if (!n->config.several) return fail(MERLIN_WRONG_USE, "model \"%s\" sees one photograph at a time", n->config.name);
    if (count < 2) return fail(MERLIN_WRONG_USE, "one photograph has no halves");
    status s = check_count(count);
    pthread_mutex_lock(&n->lock);
    if (s == OK) s = see_halves(n, &of, spread);
    pthread_mutex_unlock(&n->lock);
    return s;
}

/* Sees the lights of all photographs together. */
static status see_lights(network *n, const pictures *of, int views, int (*stop)(void), float (*lights)[MODEL_LIGHTS])
{
    status s = OK;
    memset(lights, 0, (size_t)of->count * sizeof *lights);
    for (int view = 0; view < views && s == OK; view++) {
        s = stop && stop() ? fail(MERLIN_STOPPED, "stopped") : run_view(n, of, view, light_outputs, &n->lights);
        for (int i = 0; s == OK && i < of->count; i++)
            view_add_lights(lights[i], nn_output_data(n->lights.program, "lights") + MODEL_LIGHTS * i, view,
                            1.0f / (float)views);
    }
    return s;
}

status network_lights_several(network *n, const img *photos, int count, const img *mask, const sight *how, int views,
                              int (*stop)(void), float (*lights)[MODEL_LIGHTS])
{
    const pictures of = {photos, mask, count, how};
    status s = network_check_views(views);
    if (s == OK && !n->config.several)
        s = fail(MERLIN_WRONG_USE, "model \"%s\" sees one photograph at a time", n->config.name);
    if (s == OK) s = check_count(count);
    pthread_mutex_lock(&n->lock);
    if (s == OK) s = see_lights(n, &of, views, stop, lights);
    pthread_mutex_unlock(&n->lock);
    return s;
}
