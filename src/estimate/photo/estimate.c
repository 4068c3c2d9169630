/* SPDX-License-Identifier: MIT */
/* merlin_estimate: photograph, mask, crop, network, and back to the photograph's resolution. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/progress.h"
#include "base/watch.h"
#include "estimate/light/found_light.h"
#include "estimate/light/found_light_fit.h"
#include "estimate/photo/compare.h"
#include "estimate/photo/detail.h"
#include "estimate/photo/estimate.h"
#include "estimate/photo/input.h"
#include "estimate/photo/light_choice.h"
#include "estimate/photo/mean_bounces.h"
#include "estimate/photo/model_pair.h"
#include "estimate/photo/params.h"
#include "estimate/photo/photo_doubts.h"
#include "estimate/photo/reconstruction.h"
#include "estimate/surface/exposure.h"
#include "image/coverage.h"
#include "image/read/read.h"

/* Intermediate images of one run: `crop` at the photograph's resolution, `low` at the network's; detail.h may have
 * enlarged the maps of `low`. */
typedef struct work {
    const merlin_params *params; /* NULL before estimate_photo: the defaults */
    merlin_params usual;
    img photo, mask;     /* the photograph, whose pixels are released once the crop is taken */
    merlin_image *owned; /* the photograph, if this run must free it; else NULL */
    estimate_held held;  /* zeros: nothing */
    estimate_further further;
    img *low_photos; /* of several photographs: all of them at the network's resolution, else NULL */
    crop_square crop;
    sight how;
    img crop_photo, crop_mask;
    img low_photo, low_mask;
    network_estimation low;
    surface full;
    img reconstruction, spread;
    light_cues cues;
    watch watch;  /* progress, from the params */
    double clock; /* start of the current step, in seconds */
} work;

static void work_free(work *w)
{
    img *images[] = {&w->mask,     &w->crop_photo,     &w->crop_mask, &w->low_photo,
                     &w->low_mask, &w->reconstruction, &w->spread};
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++)
        img_free(images[i]);
    for (int i = 1; w->low_photos && i <= w->further.count; i++)
        img_free(&w->low_photos[i]);
    free(w->low_photos);
    network_estimation_free(&w->low);
    surface_free(&w->full);
}

/* Adds the seconds since the last call; fails if the caller wants to stop. */
static status lap(work *w, double *seconds)
{
    double now = clock_seconds();
    *seconds += now - w->clock;
    w->clock = now;
    if (w->params->stop && w->params->stop()) return fail(MERLIN_STOPPED, "stopped");
    return OK;
}

/* Moves the object's mask into the run. */
static status take_object(work *w, merlin_object *object, merlin_maps *maps)
{
    w->mask = object->mask;
    object->mask = (img){0};
    if (!w->photo.data || w->photo.channels != 3 || !w->mask.data || w->mask.channels != 1 ||
        w->mask.width != w->photo.width || w->mask.height != w->photo.height)
        return fail(MERLIN_WRONG_USE, "this object was not found in this photograph");
    maps->mask_source = object->source;
    maps->mask_confidence = object->confidence;
    maps->timing.mask = object->seconds;
    return OK;
}

static status find_crop(work *w, merlin_maps *maps)
{
    w->crop = w->held.crop;
    status s = w->crop.side ? OK : crop_around(&w->mask, &w->crop);
    maps->crop.x = w->crop.x;
    maps->crop.y = w->crop.y;
    maps->crop.side = w->crop.side;
    return s;
}

/* Copies the object's pixels into the photograph's frame. */
static status place_photo(const work *w, merlin_image *to)
{
    img whole = {0};
    crop_square c = w->crop;
    status s = img_new(&whole, w->photo.width, w->photo.height, 3);
    for (int y = 0; s == OK && y < c.side; y++)
        for (int x = 0; x < c.side; x++) {
            float cover = *img_at(&w->crop_mask, x, y);
            if (!(cover > 0)) continue; /* the part outside the frame has no coverage */
            const float *from = img_at(&w->photo, c.x + x, c.y + y);
            float *out = img_at(&whole, c.x + x, c.y + y);
            for (int k = 0; k < 3; k++)
                out[k] = cover * from[k];
        }
    *to = whole;
    return s;
}

/* Takes the crop of photograph and mask, and the object in the photograph's frame. */
static status take_crop(work *w, merlin_image *object)
{
    status s = crop_take(&w->photo, w->crop, &w->mask, &w->crop_photo);
    if (s == OK) s = crop_take(&w->mask, w->crop, &w->mask, &w->crop_mask);
    if (s == OK) s = place_photo(w, object);
    img_free(&w->mask);
    if (w->owned) merlin_image_free(w->owned);
    w->photo.data = NULL;
    return s;
}

/* Checks the network's input. */
static status check_seen(const img *photo, const img *mask)
{
    if (coverage_is_transparent(mask))
        return fail(MERLIN_BAD_INPUT,
                    "the object is too thin or scattered: it covers half of no pixel of the %d×%d that the network "
                    "sees; give a larger size or a mask of one part",
                    mask->width, mask->height);
    for (size_t i = 0; i < img_value_count(photo); i++)
        if (photo->data[i] > 0) return OK;
    return fail(MERLIN_BAD_INPUT, "the object is black in this photograph: there is nothing to see its material by");
}

/* Determines the lens: by the caller's parameters, else by EXIF. */
static void find_lens(work *w, merlin_maps *maps)
{
    w->how = sight_of(w->params->fov, w->params->shot.focal_35mm, w->photo.width, w->photo.height, w->crop);
    w->how.flash = w->params->flash != 0;
    maps->fov = w->how.lens.fov;
    maps->slant[0] = w->how.lens.slant.right;
    maps->slant[1] = w->how.lens.slant.up;
}

/* Makes what the network sees of a further photograph. */
static status make_further(work *w, int number)
{
    img photo = {0}, crop_photo = {0}, seen = {0}, *low = &w->low_photos[1 + number];
    status s = w->further.take(w->further.context, number, &photo);
    if (s == OK && (photo.width != w->photo.width || photo.height != w->photo.height || photo.channels != 3))
        s = fail(MERLIN_BAD_INPUT, "photograph %d has %d × %d pixels, the first one %d × %d", number + 2, photo.width,
                 photo.height, w->photo.width, w->photo.height);
    if (s == OK) s = crop_take(&photo, w->crop, NULL, &crop_photo);
    img_free(&photo);
    if (s == OK) s = input_make(&crop_photo, &w->crop_mask, w->low_photo.width, low, &seen);
    if (s == OK) input_expose(low, exposure_gain(low, &w->low_mask));
    img_free(&crop_photo);
    img_free(&seen);
    return s;
}

/* Makes those of all photographs. */
static status make_all_further(work *w)
{
    const int count = w->further.count;
    if (count == 0) return OK;
    w->low_photos = calloc((size_t)count + 1, sizeof *w->low_photos);
    if (!w->low_photos) return fail(MERLIN_NO_MEMORY, "no memory for %d photographs", count + 1);
    w->low_photos[0] = w->low_photo;
    status s = OK;
    for (int i = 0; i < count && s == OK; i++)
        s = w->params->stop && w->params->stop() ? fail(MERLIN_STOPPED, "stopped") : make_further(w, i);
    return s;
}

/* Makes the picture and mask that the network sees. */
static status make_input(work *w, merlin_maps *maps)
{
    status s = take_crop(w, &maps->photo);
    if (s == OK) s = input_make(&w->crop_photo, &w->crop_mask, maps->size, &w->low_photo, &w->low_mask);
    if (s == OK) s = check_seen(&w->low_photo, &w->low_mask);
    if (s != OK) return s;
    maps->gain =
        w->params->auto_exposure ? exposure_gain(&w->low_photo, &w->low_mask) : exposure_from_ev(w->params->exposure);
    if (w->held.gain > 0) maps->gain = w->held.gain * powf(maps->gain / w->held.gain, w->held.new_share);
    input_expose(&w->low_photo, maps->gain);
    return make_all_further(w);
}

/* Improves what is estimated of several photographs by a network that compares them. */
static status compare(network *n, work *w)
{
    const merlin_params *p = w->params;
    const photo_group of = {w->low_photos, 1 + w->further.count, &w->low_mask, &w->how, p->views, p->stop};
    if (!n || !w->low_photos || !w->further.compared) return OK;
    return compare_photographs(n, &of, w->further.compared, &w->low.maps);
}

static status run_network(network *n, work *w)
{
    const merlin_params *p = w->params;
    if (!w->low_photos) return network_estimate(n, &w->low_photo, &w->low_mask, &w->how, p->views, p->stop, &w->low);
    const int count = 1 + w->further.count;
    status s = network_estimate_several(n, w->low_photos, count, &w->low_mask, &w->how, p->views, p->stop,
                                        w->further.lights, &w->low);
    if (s == OK && network_config(n)->several)
        s = network_spread_several(n, w->low_photos, count, &w->low_mask, &w->how, &w->low.spread);
    return s;
}

/* Fits the light that the network tells of the only photograph. */
static status fit_light(const network *n, work *w, const merlin_maps *maps)
{
    const network_estimation *e = &w->low;
    if (network_config(n)->lighting != MODEL_LIGHT_ANY || w->low_photos) return OK;
    const lit_photo of = {&e->maps, &w->low_photo, &e->visibility, exposure_limit(&maps->photo, maps->gain)};
    return found_light_fit(&of, w->low.lights);
}

static status follow_mean(network *n, work *w)
{
    if (w->params->views == 1 || network_config(n)->lighting == MODEL_LIGHT_ANY) return OK;
    img_free(&w->low.indirect);
    return mean_bounces(n, &w->low, &w->low.indirect);
}

/* Adds detail from a picture of this side; 0: none. */
static status add_detail(network *n, work *w, int side, float gain)
{
    const merlin_params *p = w->params;
    detail_request r = {.photo = &w->crop_photo,
                        .mask = &w->crop_mask,
                        .gain = gain,
                        .how = &w->how,
                        .side = side,
                        .views = detail_views(p->views),
                        .stop = p->stop};
    return side > 0 ? detail_add(n, &r, &w->low.maps) : OK;
}

static status resize_spread(work *w)
{
    status s = surface_resize_image(&w->low.spread, &w->low_mask, &w->crop_mask, &w->spread);
    if (s == OK) surface_tidy_spread(&w->crop_mask, &w->spread);
    return s;
}

/* Makes the maps at the crop's own resolution, and renders those of one photograph under its light. */
static status refine(work *w, const merlin_found_light *light, float gain, float white, bool in_environment)
{
    surface_encode_guide(&w->crop_photo, gain);
    status s = surface_refine(&w->low.maps, &w->crop_photo, &w->crop_mask, &w->full);
    img_free(&w->crop_photo);
    if (s == OK && w->low.spread.data) s = resize_spread(w);
    const reconstruction r = {&w->full, &w->low, &w->low_mask, &w->crop_mask, light, in_environment, white};
    return s == OK && !w->further.count ? reconstruction_render(&r, &w->reconstruction) : s;
}

static bool is_whole(const work *w)
{
    return w->crop.x == 0 && w->crop.y == 0 && w->crop.side == w->photo.width && w->crop.side == w->photo.height;
}

/* Copies a map of the crop into the photograph's frame, and frees it. */
static status place(const work *w, img *from, merlin_image *to)
{
    img whole = {0};
    if (is_whole(w)) {
        *to = *from;
        *from = whole;
        return OK;
    }
    status s = img_new(&whole, w->photo.width, w->photo.height, from->channels);
    if (s != OK) return s;
    crop_put(from, w->crop, &w->crop_mask, &whole);
    img_free(from);
    *to = whole;
    return OK;
}

static status place_all(work *w, merlin_maps *maps)
{
    status s = place(w, &w->full.albedo, &maps->albedo);
    if (s == OK) s = place(w, &w->full.normal, &maps->normal);
    if (s == OK) s = place(w, &w->full.roughness, &maps->roughness);
    if (s == OK) s = place(w, &w->full.depth, &maps->depth);
    if (s == OK) s = place(w, &w->full.mask, &maps->mask);
    if (s == OK && w->spread.data) s = place(w, &w->spread, &maps->spread);
    return s == OK && w->reconstruction.data ? place(w, &w->reconstruction, &maps->reconstruction) : s;
}

/* Finds the cues for the light in maps of the network's size, before finer normals replace theirs. photo: its size in
 * pixels. */
static status find_cues(work *w, const merlin_image *photo, float gain)
{
    const crop_square c = w->crop;
    float scale = (float)w->low_photo.width / (float)c.side;
    light_frame frame = {.left = scale * (float)-c.x,
                         .top = scale * (float)-c.y,
                         .right = scale * (float)(photo->width - c.x),
                         .bottom = scale * (float)(photo->height - c.y),
                         .white = gain};
    return light_cues_find(&w->low.maps, &w->low_photo, &frame, &w->cues);
}

/* Adds the compile time, which is measured separately: the caller may have compiled before, and choosing between two
 * networks needs one more. */
static status lap_compile(const merlin_model *model, work *w, double *seconds)
{
    double passed = 0;
    status s = lap(w, &passed);
    *seconds += network_take_compile_seconds(model->network);
    if (model->flash) *seconds += network_take_compile_seconds(model->flash);
    return s;
}

/* Compiles the networks of maps and bounces, or only that of maps if the model is released after this photograph. */
static status prepare(const merlin_model *model, network *n, work *w, merlin_maps *maps)
{
    const int views = w->params->views;
    if (w->further.count) return OK; /* its program depends on their number */
    status s = views > 1 && !w->params->last ? network_prepare_bounces(n, maps->size) : OK;
    if (s == OK) s = network_prepare(n, maps->size, views);
    return s == OK ? lap_compile(model, w, &maps->timing.compile) : s;
}

/* Compiles the network of bounces, and releases that of maps if it is not needed any more. */
static status prepare_bounces(const merlin_model *model, network *n, work *w, merlin_maps *maps)
{
    if (w->params->last) network_release_maps(n);
    status s = w->params->views > 1 ? network_prepare_bounces(n, maps->size) : OK;
    return s == OK ? lap_compile(model, w, &maps->timing.compile) : s;
}

/* Compiles the network of finer normals, and releases the previous one if it is not needed any more. */
static status prepare_finer(const merlin_model *model, network *n, work *w, int finer, merlin_maps *maps)
{
    if (w->params->last) network_release_maps(n);
    status s = finer > 0 ? network_prepare_normals(n, finer) : OK;
    return s == OK ? lap_compile(model, w, &maps->timing.compile) : s;
}

/* Chooses between the networks of a pair, of which none for flashes sees several photographs. */
static status choose_network(const merlin_model *model, const light_question *asked, const work *w, network **n)
{
    const char *name = w->held.model;
    if (w->further.count) {
        *n = model->network;
        return OK;
    }
    if (!name) return light_choice(model->network, model->flash, asked, n);
    *n = model->flash && strcmp(network_config(model->flash)->name, name) == 0 ? model->flash : model->network;
    return OK;
}

static status estimate(merlin_model *model, work *w, merlin_maps *maps)
{
    network *n = NULL;
    merlin_timing *t = &maps->timing;
    w->clock = clock_seconds();
    watch_tell(&w->watch, "estimating", 0);
    const int finer = w->further.count ? 0 : detail_side(w->params->size, w->crop.side);
    status s = make_input(w, maps);
    if (s == OK) s = lap(w, &t->prepare);
    const light_question asked = {&w->low_photo, &w->low_mask, &w->how, w->params->shot.flash};
    if (s == OK) s = choose_network(model, &asked, w, &n);
    if (s != OK) return s;
    snprintf(maps->model, sizeof maps->model, "%s", network_config(n)->name);
    s = lap(w, &t->choose);
    if (s == OK) s = lap_compile(model, w, &t->compile);
    if (w->params->last) model_keep(model, n);
    if (s == OK) s = prepare(model, n, w, maps);
    if (s == OK) s = run_network(n, w);
    if (s == OK) s = compare(model->several, w);
    if (s == OK) s = fit_light(n, w, maps);
    if (s == OK) s = lap(w, &t->network);
    if (s == OK) s = prepare_bounces(model, n, w, maps);
    maps->has_environment = network_config(n)->lighting == MODEL_LIGHT_BOTH;
    if (s == OK) s = follow_mean(n, w);
    if (s == OK) s = find_cues(w, &maps->photo, maps->gain);
    if (s == OK) s = lap(w, &t->network);
    if (s == OK) s = prepare_finer(model, n, w, finer, maps);
    if (s == OK) s = add_detail(n, w, finer, maps->gain);
    if (w->params->last) network_release_maps(n);
    if (s == OK) s = lap(w, &t->network);
    watch_tell(&w->watch, "refining", 0);
    memcpy(maps->environment, w->low.environment, sizeof maps->environment);
    if (network_config(n)->lighting == MODEL_LIGHT_ANY) found_light_take(w->low.lights, &maps->light);
    img photo = maps->photo;
    if (s == OK) maps->burnt_out = exposure_burnt_out(&w->crop_photo, &w->crop_mask);
    if (s == OK) s = refine(w, &maps->light, maps->gain, exposure_white(&photo, maps->gain), maps->has_environment);
    watch_tell(&w->watch, "refining", 0.75);
    if (s == OK) s = place_all(w, maps);
    if (s == OK) doubts_find(&w->cues, &w->params->shot, maps);
    if (s == OK) s = lap(w, &t->upsample);
    return s;
}

/* Estimates what the run was begun with: photo and, of owned, params, held and further, what is not zero. */
static status estimate_photo(merlin_model *model, work *w, merlin_object *object, merlin_maps *maps)
{
    *maps = (merlin_maps){0};
    w->usual = merlin_params_default();
    if (!w->params) w->params = &w->usual;
    const merlin_params *p = w->params;
    w->watch = (watch){p->progress, p->progress_context, p->stop};
    maps->size = network_side(p->size);
    status s = take_object(w, object, maps);
    if (s == OK) s = params_check(p);
    if (s == OK) s = find_crop(w, maps);
    if (s == OK) find_lens(w, maps);
    if (s == OK) s = estimate(model, w, maps);
    work_free(w);
    if (w->owned) merlin_image_free(w->owned);
    merlin_object_free(object);
    if (s != OK) merlin_maps_free(maps);
    return s;
}

status estimate_with_cues(merlin_model *model, merlin_image *photo, merlin_object *object, const merlin_params *params,
                          light_cues *cues, merlin_maps *maps)
{
    work w = {.photo = *photo, .owned = photo, .params = params};
    status s = estimate_photo(model, &w, object, maps);
    *cues = w.cues;
    return s;
}

status estimate_with_held(merlin_model *model, merlin_image *photo, merlin_object *object, const merlin_params *params,
                          const estimate_held *held, merlin_maps *maps)
{
    work w = {.photo = *photo, .owned = photo, .params = params};
    if (held) w.held = *held;
    return estimate_photo(model, &w, object, maps);
}

status estimate_several(merlin_model *model, merlin_image *photo, merlin_object *object, const merlin_params *params,
                        const estimate_further *further, merlin_maps *maps)
{
    work w = {.photo = *photo, .owned = photo, .params = params, .further = *further};
    return estimate_photo(model, &w, object, maps);
}

merlin_status merlin_estimate_object(merlin_model *model, merlin_image *photo, merlin_object *object,
                                     const merlin_params *params, merlin_maps *maps)
{
    if (maps) *maps = (merlin_maps){0};
    status s = api_needs(__func__, model && photo && object && maps);
    if (s == OK) {
        work w = {.photo = *photo, .owned = photo, .params = params};
        return estimate_photo(model, &w, object, maps);
    }
    merlin_image_free(photo);
    merlin_object_free(object);
    return s;
}

merlin_status merlin_estimate(merlin_model *model, const merlin_image *photo, const merlin_image *mask,
                              const merlin_params *params, merlin_maps *maps)
{
    if (maps) *maps = (merlin_maps){0};
    merlin_object object = {.seconds = 0};
    status s = api_needs(__func__, model && photo && maps);
    if (s == OK) s = merlin_object_find(photo, mask, params ? &params->hint : NULL, &object);
    if (s == OK && params && params->stop && params->stop()) s = fail(MERLIN_STOPPED, "stopped");
    if (s == OK) {
        work w = {.photo = *photo, .params = params};
        s = estimate_photo(model, &w, &object, maps);
    }
    merlin_object_free(&object);
    return s;
}
