/* maps.exr, both ways. Beside the maps it holds the photograph, so that a folder can be relit by the network too. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/half.h"
#include "estimate/api.h"
#include "estimate/exposure.h"
#include "image/exr.h"

enum { CHANNELS = 12, IMAGES = 6, PHOTO = 5 };
/* Sizes beyond NETWORK_SIZE stand in files of versions that let the network see so much. */
enum { LARGEST_WRITTEN = 1024 };

/* Name, image's place in maps_images, channel. */
typedef struct layer {
    const char *name;
    int image, channel;
} layer;

static const layer layers[CHANNELS] = {
    {"albedo.R", 0, 0}, {"albedo.G", 0, 1},    {"albedo.B", 0, 2},    {"normal.X", 1, 0},
    {"normal.Y", 1, 1}, {"normal.Z", 1, 2},    {"roughness.Y", 2, 0}, {"depth.Z", 3, 0},
    {"mask.A", 4, 0},   {"photo.R", PHOTO, 0}, {"photo.G", PHOTO, 1}, {"photo.B", PHOTO, 2},
};

static const int image_channels[IMAGES] = {3, 3, 1, 1, 1, 3};
/* What photometric stereo does not find. */
static const bool of_photographs[IMAGES] = {[2] = true, [PHOTO] = true};

/* A photograph of floats may be in a unit that half has no room or no digits for. */
static bool outgrows_half(const merlin_image *photo)
{
    const float dim = 1.0f / 64; /* half's digits go below 2^-14 */
    size_t count = 3 * (size_t)photo->width * (size_t)photo->height;
    float largest = 0;
    for (size_t i = 0; i < count; i++)
        largest = fmaxf(largest, photo->data[i]);
    return largest > HALF_LARGEST || largest < dim;
}

/* The light that was found, where a model knows it: each field of merlin_found_light behind `known`. */
enum { LIGHT_NUMBERS = 36 };
/* More is no light that a photograph can show. */
static const float MOST_LIGHT = 1e6f;

static exr_attribute attribute_of_light(const merlin_found_light *l)
{
    exr_attribute a = {.name = "merlinLight", .count = LIGHT_NUMBERS};
    float *v = a.values;
    *v++ = l->flash;
    memcpy(v, l->lamp, sizeof l->lamp), v += 3;
    *v++ = l->lamp_sure;
    *v++ = l->lamp_distance;
    memcpy(v, l->lamp_strength, sizeof l->lamp_strength), v += 3;
    memcpy(v, l->rest, sizeof l->rest);
    return a;
}

static void read_light(const exr_file *f, merlin_found_light *l)
{
    float numbers[LIGHT_NUMBERS];
    const float *v = numbers;
    if (!exr_get_numbers(f, "merlinLight", numbers, LIGHT_NUMBERS)) return;
    for (int i = 0; i < LIGHT_NUMBERS; i++)
        if (!(fabsf(numbers[i]) <= MOST_LIGHT)) return;
    l->flash = fmaxf(*v++, 0);
    memcpy(l->lamp, v, sizeof l->lamp), v += 3;
    l->lamp_sure = *v++;
    l->lamp_distance = fmaxf(*v++, 0);
    memcpy(l->lamp_strength, v, sizeof l->lamp_strength), v += 3;
    memcpy(l->rest, v, sizeof l->rest);
    l->known = 1;
}

status maps_write_exr(const merlin_maps *maps, const char *path)
{
    const merlin_image *images[IMAGES] = {&maps->albedo, &maps->normal, &maps->roughness,
                                          &maps->depth,  &maps->mask,   &maps->photo};
    exr_channel channels[CHANNELS];
    bool full = outgrows_half(&maps->photo);
    for (int i = 0; i < CHANNELS; i++)
        channels[i] = (exr_channel){layers[i].name, images[layers[i].image]->data + layers[i].channel,
                                    images[layers[i].image]->channels, full && layers[i].image == PHOTO};
    exr_attribute square = {.name = "merlinCrop", .count = 3};
    square.values[0] = (float)maps->crop.x;
    square.values[1] = (float)maps->crop.y;
    square.values[2] = (float)maps->crop.side;
    exr_attribute environment = {.name = "merlinEnvironment", .count = 27};
    memcpy(environment.values, maps->environment, sizeof maps->environment);
    exr_attribute lens = {.name = "merlinLens", .count = 3}; /* field of view and slant; 0: not known */
    lens.values[0] = maps->fov;
    lens.values[1] = maps->slant[0];
    lens.values[2] = maps->slant[1];
    exr_attribute attributes[9] = {
        square,
        lens,
        exr_number("merlinSize", (float)maps->size),
        exr_number("merlinGain", maps->gain),
        exr_number("merlinMaskFound", maps->mask_source == MERLIN_MASK_FOUND),
        exr_number("merlinMaskConfidence", maps->mask_confidence),
        exr_text("merlinModel", maps->model),
    };
    size_t count = 7;
    if (maps->has_environment) attributes[count++] = environment;
    if (maps->light.known) attributes[count++] = attribute_of_light(&maps->light);
    return exr_write(path, maps->albedo.width, maps->albedo.height, channels, CHANNELS, attributes, count);
}

/* What cannot be is not known; files of older versions do not say. */
static void read_lens(const exr_file *f, merlin_maps *maps)
{
    float lens[3];
    if (!exr_get_numbers(f, "merlinLens", lens, 3)) return;
    bool sound = lens[0] >= 1 && lens[0] <= 150 && lens[1] * lens[1] + lens[2] * lens[2] < 0.9f;
    maps->fov = sound ? lens[0] : 0;
    maps->slant[0] = sound ? lens[1] : 0;
    maps->slant[1] = sound ? lens[2] : 0;
}

static status read_attributes(const exr_file *f, const char *path, merlin_maps *maps)
{
    float square[3], size, found, confidence;
    const char *model = exr_get_text(f, "merlinModel");
    bool complete = exr_get_numbers(f, "merlinCrop", square, 3) && exr_get_numbers(f, "merlinSize", &size, 1) &&
                    exr_get_numbers(f, "merlinGain", &maps->gain, 1) &&
                    exr_get_numbers(f, "merlinMaskFound", &found, 1) &&
                    exr_get_numbers(f, "merlinMaskConfidence", &confidence, 1) && model;
    if (!complete) return fail(ERROR_INPUT, "%s was not written by merlin estimate: its attributes are missing", path);
    bool sound = fabsf(square[0]) < (float)CROP_FARTHEST && fabsf(square[1]) < (float)CROP_FARTHEST && square[2] >= 1 &&
                 square[2] < (float)CROP_FARTHEST && size >= NETWORK_LEAST_SIZE && size <= LARGEST_WRITTEN &&
                 fmodf(size, MODEL_SIZE_MULTIPLE) == 0 && exposure_is_sound(maps->gain);
    if (!sound) return fail(ERROR_INPUT, "%s: crop, size or gain is out of range", path);
    maps->crop.x = (int)square[0];
    maps->crop.y = (int)square[1];
    maps->crop.side = (int)square[2];
    maps->size = network_side((int)size);
    maps->mask_source = found != 0 ? MERLIN_MASK_FOUND : MERLIN_MASK_GIVEN;
    maps->mask_confidence = confidence >= 0 && confidence <= 1 ? confidence : 0;
    snprintf(maps->model, sizeof maps->model, "%s", model);
    read_lens(f, maps);
    read_light(f, &maps->light);
    maps->has_environment = exr_get_numbers(f, "merlinEnvironment", &maps->environment[0][0], 27);
    return OK;
}

status maps_read_layers(exr_file *f, bool photographed, merlin_maps *maps)
{
    merlin_image *images[IMAGES] = {&maps->albedo, &maps->normal, &maps->roughness,
                                    &maps->depth,  &maps->mask,   &maps->photo};
    exr_target targets[CHANNELS];
    size_t count = 0;
    for (int i = 0; i < IMAGES; i++) {
        img m = {0};
        status s = img_new(&m, exr_width(f), exr_height(f), image_channels[i]);
        if (s != OK) return s;
        *images[i] = image_of(&m);
    }
    for (int i = 0; i < CHANNELS; i++)
        if (photographed || !of_photographs[layers[i].image])
            targets[count++] = (exr_target){layers[i].name, images[layers[i].image]->data + layers[i].channel,
                                            image_channels[layers[i].image]};
    return exr_read(f, targets, count);
}

void maps_tidy(merlin_maps *maps)
{
    surface all = {img_of(&maps->albedo), img_of(&maps->normal), img_of(&maps->roughness),
                   img_of(&maps->depth),  img_of(&maps->mask),   .matte = false};
    surface_tidy(&all);
    img photo = img_of(&maps->photo);
    img_blacken_impossible(&photo);
}

merlin_status merlin_maps_read(const char *folder, merlin_maps *maps)
{
    if (maps) *maps = (merlin_maps){0};
    status s = api_needs(__func__, folder && maps);
    if (s != OK) return result_of(s);
    char *path = file_join(folder, "maps.exr");
    if (!path) return result_of(fail(ERROR_MEMORY, "no memory for a file name"));
    exr_file *f = NULL;
    s = file_exists(path) ? exr_open(path, &f)
                          : fail(ERROR_INPUT, "no maps.exr in %s: run merlin estimate first", folder);
    if (s == OK) s = read_attributes(f, path, maps);
    if (s == OK) s = maps_read_layers(f, true, maps);
    if (f) exr_close(f);
    free(path);
    if (s != OK) {
        merlin_maps_free(maps);
        return result_of(s);
    }
    maps_tidy(maps);
    img photo = img_of(&maps->photo), mask = img_of(&maps->mask);
    maps->burnt_out = exposure_burnt_out(&photo, &mask);
    return MERLIN_OK;
}
