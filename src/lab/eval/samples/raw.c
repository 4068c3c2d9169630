/* SPDX-License-Identifier: MIT */
#include "lab/eval/samples/raw.h"

#include <stdio.h>
#include <string.h>

#include "estimate/photo/input.h"
#include "estimate/photo/mean_bounces.h"
#include "lab/eval/samples/truth.h"

/* Tells what the network is told of the lens: models of one light take every lens for the usual one. */
static sight sight_by(const network *n, const eval_photo *photo)
{
    sight how = {.flash = false};
    if (network_config(n)->lighting == MODEL_LIGHT_ANY) how.lens = photo->lens;
    return how;
}

static status radiance_of(const eval_photo *photo, img *out)
{
    status s = img_copy(out, &photo->picture);
    if (s == OK) input_expose(out, photo->white);
    return s;
}

static status see(network *n, const eval_photo *photo, int views, network_estimation *out)
{
    const sight how = sight_by(n, photo);
    img radiance = {0};
    status s = radiance_of(photo, &radiance);
    if (s == OK) s = network_see(n, &radiance, &photo->mask, &how, views, NULL, out);
    img_free(&radiance);
    if (s != OK) return s;
    sight_take_relief(how.lens, &photo->mask, &out->maps.depth);
    img *normal = &out->maps.normal;
    for (size_t i = 0; views > 1 && i < img_value_count(normal); i += 3)
        vec3_put(vec3_normalize(vec3_of(normal->data + i)), normal->data + i);
    return views > 1 ? mean_bounces(n, out, &out->indirect) : OK;
}

/* Draws what the maps explain, in the photograph's values. */
static status reconstruct(const network *n, const eval_photo *photo, const network_estimation *e, img *out)
{
    const float(*sh)[3] = (const float(*)[3])e->environment;
    const illumination light = {{0, 0, 0}, network_config(n)->lighting == MODEL_LIGHT_BOTH ? sh : NULL};
    img direct = {0};
    status s = eval_render(&e->maps, &light, 1, &direct);
    if (s == OK) s = eval_picture(&direct, &e->indirect, &photo->mask, out);
    img_free(&direct);
    if (s == OK) input_expose(out, 1 / photo->white);
    return s;
}

static merlin_image move(img *from)
{
    const merlin_image moved = *from;
    *from = (img){0};
    return moved;
}

status raw_estimate(merlin_model *model, const eval_photo *photo, int views, merlin_maps *maps)
{
    network *n = model->network;
    network_estimation e = {0};
    img picture = {0}, reconstruction = {0};
    const int side = photo->picture.width;
    *maps = (merlin_maps){.crop = {0, 0, side},
                          .size = network_side(side),
                          .gain = photo->white,
                          .fov = photo->lens.fov,
                          .mask_confidence = 1,
                          .has_environment = network_config(n)->lighting == MODEL_LIGHT_BOTH};
    status s = see(n, photo, views, &e);
    if (s == OK) s = reconstruct(n, photo, &e, &reconstruction);
    if (s == OK) s = img_copy(&picture, &photo->picture);
    if (s == OK) {
        img *from[] = {&e.maps.albedo, &e.maps.normal, &e.maps.roughness, &e.maps.depth,
                       &e.maps.mask,   &picture,       &reconstruction};
        merlin_image *to[] = {&maps->albedo, &maps->normal, &maps->roughness,     &maps->depth,
                              &maps->mask,   &maps->photo,  &maps->reconstruction};
        for (int i = 0; i < 7; i++)
            *to[i] = move(from[i]);
        memcpy(maps->environment, e.environment, sizeof maps->environment);
        snprintf(maps->model, sizeof maps->model, "%s", network_config(n)->name);
    }
    network_estimation_free(&e);
    return s;
}

status raw_features(merlin_model *model, const eval_photo *photo, int views, network_features **out)
{
    network *n = model->network;
    const sight how = sight_by(n, photo);
    img radiance = {0};
    *out = NULL;
    if (network_config(n)->relight != MODEL_RELIGHT_NETWORK) return OK;
    status s = radiance_of(photo, &radiance);
    if (s == OK) s = network_features_new(n, &radiance, &photo->mask, &how, views, out);
    img_free(&radiance);
    return s;
}
