/* SPDX-License-Identifier: MIT */
#include "page_calls.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/file.h"
#include "base/progress.h"
#include "base/threads.h"
#include "estimate/files/map_png.h"
#include "estimate/files/maps_files.h"
#include "image/color.h"
#include "image/metadata/exif.h"
#include "image/metadata/exif_find.h"
#include "image/write/jpeg.h"
#include "image/write/write.h"
#include "merlin/merlin.h"
#include "recorded_networks.h"

/* The one photograph, and what was made of it. */
static struct {
    merlin_model *model;
    img photo, alpha;
    merlin_object object;
    merlin_shot shot;
    merlin_params params;
    merlin_maps maps;
} page;

/* ---- what the library asks of a system ---- */

void threads_begin(void)
{
}

double clock_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void *page_alloc(size_t size)
{
    return malloc(size);
}

void page_free(void *memory)
{
    free(memory);
}

const char *page_version(void)
{
    return merlin_version();
}

const char *page_error(void)
{
    return status_message();
}

/* The maps are PNG. */
status jpeg_encode(const char *name, const img *image, uint8_t **data, size_t *size)
{
    (void)image;
    *data = NULL;
    *size = 0;
    return fail(MERLIN_WRONG_USE, "no JPEG is made here: %s", name);
}

/* ---- networks ---- */

int page_network(const char *network, const char *name, int channels, int reduction, int is_input)
{
    return (int)network_value_add(network, name, channels, reduction, is_input != 0);
}

int page_open(const char *any, const char *flash)
{
    merlin_model_close(page.model);
    page.model = NULL;
    status s = merlin_model_open(any, &page.model);
    if (s == OK && *flash) s = merlin_model_add_flash(page.model, flash);
    return (int)s;
}

/* ---- photograph and mask ---- */

static void read_shot(const uint8_t *file, size_t size, int width, int height)
{
    byte_source bytes;
    exif_place place;
    exif_facts facts = {0};
    byte_source_of_memory(&bytes, file, size);
    if (exif_find(&bytes, &place)) exif_parse_part(&bytes, place.at, place.size, &facts);
    page.shot = (merlin_shot){.focal_35mm = exif_focal_35mm(&facts, width, height)};
    if (facts.flash == EXIF_FLASH_NONE) page.shot.flash = MERLIN_FLASH_NONE;
    if (facts.flash == EXIF_FLASH_FIRED) page.shot.flash = MERLIN_FLASH_FIRED;
}

int page_photo(const uint8_t *rgba, int width, int height, const uint8_t *file, size_t size)
{
    const float *linear = srgb_decode_table8();
    const size_t count = (size_t)width * (size_t)height;
    bool opaque = true;
    networks_forget();
    merlin_maps_free(&page.maps);
    merlin_object_free(&page.object);
    img_free(&page.photo);
    img_free(&page.alpha);
    read_shot(file, size, width, height);
    status s = img_new(&page.photo, width, height, 3);
    if (s == OK) s = img_new(&page.alpha, width, height, 1);
    for (size_t i = 0; s == OK && i < count; i++) {
        for (size_t c = 0; c < 3; c++)
            page.photo.data[3 * i + c] = linear[rgba[4 * i + c]];
        page.alpha.data[i] = (float)rgba[4 * i + 3] / 255;
        opaque &= rgba[4 * i + 3] == 255;
    }
    if (opaque) img_free(&page.alpha);
    return (int)s;
}

float page_focal(void)
{
    return page.shot.focal_35mm;
}

static status find(const img *mask)
{
    merlin_object_free(&page.object);
    return merlin_object_find(&page.photo, mask, NULL, &page.object);
}

int page_find(void)
{
    return (int)find(page.alpha.data ? &page.alpha : NULL);
}

int page_set_mask(const uint8_t *mask)
{
    img given = {0};
    status s = img_new(&given, page.photo.width, page.photo.height, 1);
    for (size_t i = 0; s == OK && i < img_value_count(&given); i++)
        given.data[i] = (float)mask[i] / 255;
    if (s == OK) s = find(&given);
    img_free(&given);
    return (int)s;
}

int page_get_mask(uint8_t *mask)
{
    for (size_t i = 0; i < img_value_count(&page.object.mask); i++)
        mask[i] = (uint8_t)(255 * page.object.mask.data[i] + 0.5f);
    return page.object.mask.data ? OK : MERLIN_WRONG_USE;
}

float page_confidence(void)
{
    return page.object.confidence;
}

/* ---- the estimate ---- */

int page_begin(float fov, int flash, int size, int views)
{
    networks_forget();
    page.params = merlin_params_default();
    page.params.fov = fov;
    page.params.flash = flash;
    page.params.size = size;
    page.params.views = views;
    page.params.shot = page.shot;
    return OK;
}

int page_step(void)
{
    merlin_image photo = {0};
    merlin_object object = page.object;
    object.mask = (merlin_image){0};
    networks_rewind();
    merlin_maps_free(&page.maps);
    if (!page.photo.data || !page.object.mask.data)
        return (int)fail(MERLIN_BAD_INPUT, "there is no mask: paint the object");
    status s = img_copy(&photo, &page.photo);
    if (s == OK) s = img_copy(&object.mask, &page.object.mask);
    if (s == OK) return (int)merlin_estimate_object(page.model, &photo, &object, &page.params, &page.maps);
    merlin_image_free(&photo);
    merlin_object_free(&object);
    return (int)s;
}

static const network_value *value_at(int is_input, int i)
{
    const network_run *run = networks_wanted();
    return is_input ? &run->inputs[i] : &run->outputs[i];
}

const char *page_run_network(void)
{
    const network_run *run = networks_wanted();
    return run ? run->network : "";
}

int page_run_count(int is_input)
{
    return is_input ? networks_wanted()->input_count : networks_wanted()->output_count;
}

const char *page_run_name(int is_input, int i)
{
    return value_at(is_input, i)->name;
}

int page_run_channels(int is_input, int i)
{
    return value_at(is_input, i)->channels;
}

int page_run_side(int is_input, int i)
{
    return value_at(is_input, i)->side;
}

float *page_run_data(int is_input, int i)
{
    return value_at(is_input, i)->data;
}

void page_answered(void)
{
    networks_answered();
}

/* ---- files ---- */

static status write_report(void)
{
    char *text = NULL;
    status s = merlin_maps_report(&page.maps, &text);
    if (s == OK) s = file_write("report.json", text, strlen(text));
    free(text);
    return s;
}

int page_write(const char *name)
{
    const merlin_maps *m = &page.maps;
    const merlin_view_params view = {.name = name};
    status s = img_write_png("albedo.png", &m->albedo, IMG_SRGB8);
    if (s == OK) s = map_write_normals("normal.png", &m->normal, &m->mask);
    if (s == OK) s = img_write_png("roughness.png", &m->roughness, IMG_LINEAR8);
    if (s == OK) s = map_write_depths("depth.png", &m->depth, &m->mask);
    if (s == OK) s = img_write_png("mask.png", &m->mask, IMG_LINEAR8);
    if (s == OK) s = img_write_png("reconstruction.png", &m->reconstruction, IMG_SRGB8);
    if (s == OK) s = maps_write_exr(m, "maps.exr");
    if (s == OK) s = write_report();
    if (s == OK) s = merlin_view_write(m, &view, "viewer.html");
    return (int)s;
}
