/* SPDX-License-Identifier: MIT */
/* Reads and writes the maps.exr of a photograph. It also contains the photograph, so that the network, too, can relight
 * a folder. */
#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "estimate/files/maps_examine.h"
#include "estimate/files/maps_files.h"
#include "estimate/photo/network.h"
#include "estimate/surface/crop.h"
#include "estimate/surface/exposure.h"
#include "estimate/surface/surface.h"
#include "image/exr/exr_place.h"
#include "image/read/read.h"
#include "model/model.h"

enum { CHANNELS = 13, IMAGES = 7, PHOTO = 5, SPREAD = 6 };
/* Largest network size in a file: earlier versions allowed sizes beyond NETWORK_SIZE. */
enum { LARGEST_WRITTEN = 1024 };

/* Name of a channel, its image's index in maps_images, and the channel there. */
typedef struct layer {
    const char *name;
    int image, channel;
} layer;

static const layer layers[CHANNELS] = {
    {"albedo.R", 0, 0},    {"albedo.G", 0, 1},    {"albedo.B", 0, 2},      {"normal.X", 1, 0}, {"normal.Y", 1, 1},
    {"normal.Z", 1, 2},    {"roughness.Y", 2, 0}, {"depth.Z", 3, 0},       {"mask.A", 4, 0},   {"photo.R", PHOTO, 0},
    {"photo.G", PHOTO, 1}, {"photo.B", PHOTO, 2}, {"spread.Y", SPREAD, 0},
};

static const int image_channels[IMAGES] = {3, 3, 1, 1, 1, 3, 1};
/* Images that photometric stereo does not find. */
static const bool of_photographs[IMAGES] = {[2] = true, [PHOTO] = true};

/* Tells whether a photograph of floats is in a unit for which half has too little range or precision. */
static bool outgrows_half(const merlin_image *photo)
{
    const float dim = 1.0f / 64; /* half loses precision below 2^-14 */
    size_t count = 3 * (size_t)photo->width * (size_t)photo->height;
    float largest = 0;
    for (size_t i = 0; i < count; i++)
        largest = fmaxf(largest, photo->data[i]);
    return largest > HALF_LARGEST || largest < dim;
}

/* merlinLight, where a model knows the light: the fields of merlin_found_light after `known`, in their order. */
enum { LIGHT_NUMBERS = 36, LIGHT_BEGINS = offsetof(merlin_found_light, flash) };
static_assert(LIGHT_BEGINS + LIGHT_NUMBERS * sizeof(float) == sizeof(merlin_found_light),
              "what a file holds of a light is all that stands behind `known`");
/* Numbers of attributes: in every file, and at most. */
enum { ALWAYS = 8, MOST_ATTRIBUTES = ALWAYS + 2 };
/* Largest value of a light that a photograph can show. */
static const float MOST_LIGHT = 1e6f;

static exr_attribute attribute_of_light(const merlin_found_light *l)
{
    exr_attribute a = {.name = "merlinLight", .count = LIGHT_NUMBERS};
    memcpy(a.values, (const char *)l + LIGHT_BEGINS, LIGHT_NUMBERS * sizeof *a.values);
    return a;
}

status maps_write_exr(const merlin_maps *maps, const char *path)
{
    const merlin_image *images[IMAGES] = {&maps->albedo, &maps->normal, &maps->roughness, &maps->depth,
                                          &maps->mask,   &maps->photo,  &maps->spread};
    exr_channel channels[CHANNELS];
    const size_t channel_count = maps->spread.data ? CHANNELS : CHANNELS - 1;
    bool full = outgrows_half(&maps->photo);
    for (size_t i = 0; i < channel_count; i++)
        channels[i] = (exr_channel){layers[i].name, images[layers[i].image]->data + layers[i].channel,
                                    images[layers[i].image]->channels, full && layers[i].image == PHOTO};
    exr_attribute square = {.name = "merlinCrop", .count = 3};
    square.values[0] = (float)maps->crop.x;
    square.values[1] = (float)maps->crop.y;
    square.values[2] = (float)maps->crop.side;
    exr_attribute environment = {.name = "merlinEnvironment", .count = 27};
    memcpy(environment.values, maps->environment, sizeof maps->environment);
    exr_attribute lens = {.name = "merlinLens", .count = 3}; /* field of view and slant; 0: unknown */
    lens.values[0] = maps->fov;
    lens.values[1] = maps->slant[0];
    lens.values[2] = maps->slant[1];
    exr_attribute attributes[MOST_ATTRIBUTES] = {
        square,
        lens,
        maps_picture_size(maps->albedo.width, maps->albedo.height),
        exr_number("merlinSize", (float)maps->size),
        exr_number("merlinGain", maps->gain),
        exr_number("merlinMaskFound", maps->mask_source == MERLIN_MASK_FOUND),
        exr_number("merlinMaskConfidence", maps->mask_confidence),
        exr_text("merlinModel", maps->model),
    };
    size_t count = ALWAYS;
    if (maps->has_environment) attributes[count++] = environment;
    if (maps->light.known) attributes[count++] = attribute_of_light(&maps->light);
    return exr_write(path, maps->albedo.width, maps->albedo.height, channels, channel_count, attributes, count);
}

/* ---- attributes ---- */

exr_attribute maps_picture_size(int width, int height)
{
    return (exr_attribute){.name = "merlinPicture", .values = {(float)width, (float)height}, .count = 2};
}

/* Reads numbers that must be present. */
static status take_numbers(const exr_file *f, const char *path, const char *name, float *values, int count)
{
    if (exr_get_numbers(f, name, values, count)) return OK;
    return exr_has_attribute(f, name)
               ? fail(MERLIN_BAD_INPUT, "%s: its attribute %s should be %d finite numbers", path, name, count)
               : fail(MERLIN_BAD_INPUT, "%s was not written by merlin estimate: its attribute %s is missing", path,
                      name);
}

/* Reads numbers that files of older versions do not have. */
static status take_if_there(const exr_file *f, const char *path, const char *name, float *values, int count)
{
    return exr_has_attribute(f, name) ? take_numbers(f, path, name, values, count) : OK;
}

static status read_lens(const exr_file *f, const char *path, merlin_maps *maps)
{
    float lens[3] = {0};
    status s = take_if_there(f, path, "merlinLens", lens, 3);
    if (s != OK) return s;
    bool sound = (lens[0] == 0 || (lens[0] >= 1 && lens[0] <= 150)) && lens[1] * lens[1] + lens[2] * lens[2] < 0.9f;
    if (!sound)
        return fail(MERLIN_BAD_INPUT,
                    "%s: no lens is as merlinLens says, %g degrees wide and slanted by %g, %g: the width is 1 to 150, "
                    "or 0 for unknown",
                    path, (double)lens[0], (double)lens[1], (double)lens[2]);
    maps->fov = lens[0];
    maps->slant[0] = lens[0] > 0 ? lens[1] : 0;
    maps->slant[1] = lens[0] > 0 ? lens[2] : 0;
    return OK;
}

static status read_crop(const exr_file *f, const char *path, merlin_maps *maps)
{
    float square[3];
    status s = take_numbers(f, path, "merlinCrop", square, 3);
    if (s != OK) return s;
    bool sound = fabsf(square[0]) < (float)CROP_FARTHEST && fabsf(square[1]) < (float)CROP_FARTHEST && square[2] >= 1 &&
                 square[2] < (float)CROP_FARTHEST;
    if (!sound)
        return fail(MERLIN_BAD_INPUT, "%s: merlinCrop, %g, %g and a side of %g, is out of range", path,
                    (double)square[0], (double)square[1], (double)square[2]);
    maps->crop.x = (int)square[0];
    maps->crop.y = (int)square[1];
    maps->crop.side = (int)square[2];
    return OK;
}

static status read_exposure(const exr_file *f, const char *path, merlin_maps *maps)
{
    float size;
    status s = take_numbers(f, path, "merlinSize", &size, 1);
    if (s == OK) s = take_numbers(f, path, "merlinGain", &maps->gain, 1);
    if (s != OK) return s;
    bool sound = size >= NETWORK_LEAST_SIZE && size <= LARGEST_WRITTEN && fmodf(size, MODEL_SIZE_MULTIPLE) == 0 &&
                 exposure_is_sound(maps->gain);
    if (!sound)
        return fail(MERLIN_BAD_INPUT, "%s: merlinSize %g or merlinGain %g is out of range", path, (double)size,
                    (double)maps->gain);
    maps->size = network_side((int)size);
    return OK;
}

static status read_mask_source(const exr_file *f, const char *path, merlin_maps *maps)
{
    float found, confidence;
    status s = take_numbers(f, path, "merlinMaskFound", &found, 1);
    if (s == OK) s = take_numbers(f, path, "merlinMaskConfidence", &confidence, 1);
    if (s != OK) return s;
    maps->mask_source = found != 0 ? MERLIN_MASK_FOUND : MERLIN_MASK_GIVEN;
    maps->mask_confidence = confidence >= 0 && confidence <= 1 ? confidence : 0;
    return OK;
}

static status read_light(const exr_file *f, const char *path, merlin_found_light *l)
{
    float numbers[LIGHT_NUMBERS];
    if (!exr_has_attribute(f, "merlinLight")) return OK;
    status s = take_numbers(f, path, "merlinLight", numbers, LIGHT_NUMBERS);
    if (s != OK) return s;
    for (int i = 0; i < LIGHT_NUMBERS; i++)
        if (!(fabsf(numbers[i]) <= MOST_LIGHT))
            return fail(MERLIN_BAD_INPUT, "%s: merlinLight's %g is out of range", path, (double)numbers[i]);
    memcpy((char *)l + LIGHT_BEGINS, numbers, sizeof numbers);
    l->flash = fmaxf(l->flash, 0);
    l->lamp_distance = fmaxf(l->lamp_distance, 0);
    l->known = 1;
    return OK;
}

static status read_attributes(const exr_file *f, const char *path, merlin_maps *maps)
{
    status s = read_crop(f, path, maps);
    if (s == OK) s = read_exposure(f, path, maps);
    if (s == OK) s = read_mask_source(f, path, maps);
    if (s == OK) s = read_lens(f, path, maps);
    if (s == OK) s = read_light(f, path, &maps->light);
    if (s == OK) s = take_if_there(f, path, "merlinEnvironment", &maps->environment[0][0], 27);
    if (s != OK) return s;
    const char *model = exr_get_text(f, "merlinModel");
    if (!model)
        return fail(MERLIN_BAD_INPUT, "%s was not written by merlin estimate: its attribute merlinModel is missing",
                    path);
    snprintf(maps->model, sizeof maps->model, "%s", model);
    maps->has_environment = exr_has_attribute(f, "merlinEnvironment");
    return OK;
}

/* ---- pixels ---- */

/* Refuses a file whose size differs from the one written, to which the crop, focal lengths and depths in pixels refer.
 */
static status check_picture(const exr_file *f, const char *path)
{
    const exr_frame seen = exr_display(f);
    float size[2] = {(float)seen.width, (float)seen.height};
    status s = take_if_there(f, path, "merlinPicture", size, 2);
    if (s != OK) return s;
    if (size[0] != (float)seen.width || size[1] != (float)seen.height)
        return fail(MERLIN_BAD_INPUT,
                    "%s is %lld x %lld pixels now and was written with %.0f x %.0f: resize or crop the photographs, "
                    "and make the maps of them",
                    path, seen.width, seen.height, (double)size[0], (double)size[1]);
    bool trimmed = seen.width != exr_width(f) || seen.height != exr_height(f);
    bool fits = seen.width >= 1 && seen.height >= 1 && seen.width <= IMAGE_MAX_SIDE && seen.height <= IMAGE_MAX_SIDE &&
                seen.width * seen.height <= IMAGE_MOST_PIXELS;
    return !trimmed || fits ? OK : fail(MERLIN_BAD_INPUT, "%s: no photograph is of its display window's size", path);
}

/* Places the images in the picture: some programs store only the part that is not black, and its position. */
static status place_images(const exr_file *f, merlin_image *const images[IMAGES])
{
    const exr_frame seen = exr_display(f);
    status s = OK;
    bool whole = seen.left == 0 && seen.top == 0 && seen.width == exr_width(f) && seen.height == exr_height(f);
    for (int i = 0; i < IMAGES && s == OK && !whole; i++) {
        if (!images[i]->data) continue;
        img m = *images[i];
        s = exr_place(&seen, &m);
        *images[i] = m;
    }
    return s;
}

static status new_images(const exr_file *f, merlin_image *const images[IMAGES])
{
    status s = OK;
    for (int i = 0; i < IMAGES && s == OK; i++) {
        if (i == SPREAD && !exr_has_channel(f, layers[CHANNELS - 1].name)) continue;
        img m = {0};
        s = img_new(&m, exr_width(f), exr_height(f), image_channels[i]);
        if (s == OK) *images[i] = m;
    }
    return s;
}

/* Lists the channels that the file has. */
static size_t list_channels(bool photographed, merlin_image *const images[IMAGES], exr_target targets[CHANNELS])
{
    size_t count = 0;
    for (int i = 0; i < CHANNELS; i++)
        if (images[layers[i].image]->data && (photographed || !of_photographs[layers[i].image]))
            targets[count++] = (exr_target){layers[i].name, images[layers[i].image]->data + layers[i].channel,
                                            image_channels[layers[i].image]};
    return count;
}

status maps_read_layers(exr_file *f, const char *path, bool photographed, merlin_maps *maps)
{
    merlin_image *const images[IMAGES] = {&maps->albedo, &maps->normal, &maps->roughness, &maps->depth,
                                          &maps->mask,   &maps->photo,  &maps->spread};
    exr_target targets[CHANNELS];
    status s = check_picture(f, path);
    if (s == OK) s = new_images(f, images);
    if (s == OK) s = exr_read(f, targets, list_channels(photographed, images, targets));
    if (s == OK) s = place_images(f, images);
    if (s != OK) return s;
    return maps_examine(path, targets, list_channels(photographed, images, targets), maps);
}

status maps_check_values(const char *where, const merlin_maps *maps)
{
    merlin_maps m = *maps;
    merlin_image *const images[IMAGES] = {&m.albedo, &m.normal, &m.roughness, &m.depth, &m.mask, &m.photo, &m.spread};
    exr_target targets[CHANNELS];
    status s = maps_look_through(where, targets, list_channels(true, images, targets), maps);
    return s == OK ? maps_check_crop(where, true, maps) : s;
}

void maps_tidy(merlin_maps *maps)
{
    surface all = {maps->albedo, maps->normal, maps->roughness, maps->depth, maps->mask, .matte = false};
    surface_tidy(&all);
    img photo = maps->photo;
    img_zero_invalid(&photo);
    if (maps->spread.data) surface_tidy_spread(&maps->mask, &maps->spread);
}

status maps_read_photographed(exr_file *f, const char *path, merlin_maps *maps)
{
    status s = read_attributes(f, path, maps);
    if (s == OK) s = maps_read_layers(f, path, true, maps);
    if (s == OK) s = maps_check_crop(path, exr_has_attribute(f, "merlinPicture"), maps);
    if (s != OK) return s;
    maps_tidy(maps);
    img photo = maps->photo, mask = maps->mask;
    maps->burnt_out = exposure_burnt_out(&photo, &mask);
    return OK;
}
