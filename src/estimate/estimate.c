/* merlin_estimate: photograph, mask, crop, network, and back to the photograph's resolution. */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/progress.h"
#include "estimate/api.h"
#include "estimate/exposure.h"
#include "estimate/mask.h"
#include "estimate/relight_env.h"
#include "image/resize.h"

enum { LEAST_SIDE = 16, MOST_PIXELS = 64 * 1000 * 1000 };

/* One run's intermediate images: `crop` at the photograph's resolution, `low` at the network's. */
typedef struct work {
    const merlin_params *params;
    img photo, mask;
    crop_square crop;
    img crop_photo, crop_mask;
    img low_photo, low_mask;
    network_estimation low;
    surface full;
    img reconstruction;
    double clock; /* when the current stage began */
} work;

static void work_free(work *w)
{
    img *images[] = {&w->mask, &w->crop_photo, &w->crop_mask, &w->low_photo, &w->low_mask, &w->reconstruction};
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++)
        img_free(images[i]);
    network_estimation_free(&w->low);
    surface_free(&w->full);
}

/* Seconds since the last call; fails if the caller wants to stop. */
static status lap(work *w, double *seconds)
{
    double now = clock_seconds();
    *seconds = now - w->clock;
    w->clock = now;
    if (w->params->stop && w->params->stop()) return fail(ERROR_STOPPED, "stopped");
    return OK;
}

static status check_photo(const img *photo)
{
    if (photo->channels != 3 || !photo->data) return fail(ERROR_USAGE, "a photograph needs 3 channels");
    if (photo->width < LEAST_SIDE || photo->height < LEAST_SIDE)
        return fail(ERROR_INPUT, "the photograph is %d×%d pixels; at least %d×%d are needed", photo->width,
                    photo->height, LEAST_SIDE, LEAST_SIDE);
    if ((size_t)photo->width * (size_t)photo->height > MOST_PIXELS)
        return fail(ERROR_INPUT, "the photograph has %d×%d pixels, more than 64 million; make it smaller first",
                    photo->width, photo->height);
    size_t count = 3 * (size_t)photo->width * (size_t)photo->height;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(photo->data[i])) return fail(ERROR_INPUT, "the photograph has values that are not finite");
    return OK;
}

static status choose_mask(work *w, const merlin_image *given, merlin_maps *maps)
{
    mask_choice choice;
    img mask = {0};
    if (given) mask = img_of(given);
    status s = mask_choose(&w->photo, &mask, &w->mask, &choice);
    if (s == OK) s = crop_around(&w->mask, &w->crop);
    if (s != OK) return s;
    maps->mask_source = choice.found ? MERLIN_MASK_FOUND : MERLIN_MASK_GIVEN;
    maps->mask_confidence = choice.confidence;
    maps->crop.x = w->crop.x;
    maps->crop.y = w->crop.y;
    maps->crop.side = w->crop.side;
    return OK;
}

static void multiply_mask(img *image, const img *mask)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    assert(mask->data);
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < image->channels; c++)
            image->data[(size_t)image->channels * i + (size_t)c] *= mask->data[i];
}

/* The picture and mask that the network sees, like a rendered sample: the photograph multiplied by coverage and
 * area-averaged, the mask hard. */
static status make_input(work *w, float *gain)
{
    int size = w->params->size;
    img masked = {0};
    status s = crop_take(&w->photo, w->crop, &w->crop_photo);
    if (s == OK) s = crop_take(&w->mask, w->crop, &w->crop_mask);
    if (s == OK) s = img_copy(&masked, &w->crop_photo);
    if (s == OK) {
        multiply_mask(&masked, &w->crop_mask);
        s = img_resize(&masked, size, size, &w->low_photo);
    }
    if (s == OK) s = img_resize(&w->crop_mask, size, size, &w->low_mask);
    img_free(&masked);
    if (s != OK) return s;
    harden_mask(&w->low_photo, &w->low_mask);
    *gain =
        w->params->auto_exposure ? exposure_gain(&w->low_photo, &w->low_mask) : exposure_from_ev(w->params->exposure);
    size_t count = 3 * (size_t)size * (size_t)size;
    for (size_t i = 0; i < count; i++)
        w->low_photo.data[i] *= *gain;
    return OK;
}

/* The maps at the crop's own resolution, and what they look like under the photograph's light in its exposure. */
static status refine(work *w, float gain, bool in_environment)
{
    status s = surface_refine(&w->low.maps, &w->crop_photo, &w->crop_mask, &w->full);
    if (s == OK) s = surface_shade(&w->full, vec3_make(0, 0, 0), &w->reconstruction);
    img indirect = {0};
    if (s == OK)
        s = surface_resize_indirect(&w->low.indirect, &w->low.maps.mask, w->crop.side, w->crop.side, &indirect);
    if (s != OK) return s;
    if (in_environment) {
        const float(*sh)[3] = (const float(*)[3])w->low.environment;
        surface_add_ambient(&w->full, sh, &w->reconstruction);
        surface_add_ambient_highlights(&w->full, sh, &w->reconstruction);
    }
    size_t count = 3 * (size_t)w->crop.side * (size_t)w->crop.side;
    for (size_t i = 0; i < count; i++) {
        float radiance = w->reconstruction.data[i] + indirect.data[i] * w->crop_mask.data[i / 3];
        w->reconstruction.data[i] = fminf(fmaxf(radiance / gain, 0), 1);
    }
    img_free(&indirect);
    return OK;
}

/* From the crop to the photograph's frame; frees the crop's. */
static status place(const work *w, img *from, merlin_image *to)
{
    img whole = {0};
    status s = img_new(&whole, w->photo.width, w->photo.height, from->channels);
    if (s != OK) return s;
    crop_put(from, w->crop, &whole);
    img_free(from);
    *to = image_of(&whole);
    return OK;
}

static status place_all(work *w, merlin_maps *maps)
{
    status s = place(w, &w->full.albedo, &maps->albedo);
    if (s == OK) s = place(w, &w->full.normal, &maps->normal);
    if (s == OK) s = place(w, &w->full.roughness, &maps->roughness);
    if (s == OK) s = place(w, &w->full.depth, &maps->depth);
    if (s == OK) s = place(w, &w->full.mask, &maps->mask);
    if (s == OK) s = place(w, &w->reconstruction, &maps->reconstruction);
    if (s != OK) return s;
    multiply_mask(&w->crop_photo, &w->crop_mask);
    return place(w, &w->crop_photo, &maps->photo);
}

static status estimate(merlin_model *model, work *w, const merlin_image *mask, merlin_maps *maps)
{
    network *n = model->network;
    merlin_timing *t = &maps->timing;
    w->clock = clock_seconds();
    status s = check_photo(&w->photo);
    if (s == OK) s = choose_mask(w, mask, maps);
    if (s == OK) s = lap(w, &t->mask);
    if (s == OK) s = network_prepare(n, w->params->size);
    /* the caller may have had it compiled before */
    if (s == OK) s = lap(w, &t->compile);
    t->compile = network_take_compile_seconds(n);
    if (s == OK) s = make_input(w, &maps->gain);
    if (s == OK) s = lap(w, &t->prepare);
    if (s == OK) s = network_estimate(n, &w->low_photo, &w->low_mask, w->params->views, w->params->stop, &w->low);
    if (s == OK) s = lap(w, &t->network);
    maps->has_environment = network_config(n)->lighting == MODEL_LIGHT_BOTH;
    memcpy(maps->environment, w->low.environment, sizeof maps->environment);
    if (s == OK) s = refine(w, maps->gain, maps->has_environment);
    if (s == OK) s = place_all(w, maps);
    if (s == OK) s = lap(w, &t->upsample);
    return s;
}

merlin_status merlin_estimate(merlin_model *model, const merlin_image *photo, const merlin_image *mask,
                              const merlin_params *params, merlin_maps *maps)
{
    *maps = (merlin_maps){0};
    merlin_params defaults = merlin_params_default();
    work w = {.params = params ? params : &defaults, .photo = img_of(photo)};
    maps->size = w.params->size;
    snprintf(maps->model, sizeof maps->model, "%s", network_config(model->network)->name);
    status s = estimate(model, &w, mask, maps);
    work_free(&w);
    if (s != OK) merlin_maps_free(maps);
    return result_of(s);
}
