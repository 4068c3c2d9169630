/* SPDX-License-Identifier: MIT */
#include "estimate/files/overview.h"

#include <string.h>

#include "estimate/relight/maps_surface.h"
#include "estimate/surface/exposure.h"
#include "image/color.h"
#include "image/resize.h"

static const vec3 from_left = {-0.67f, 0.47f, -0.43f}, from_right = {0.77f, 0.28f, -0.43f};

void overview_free(overview *o)
{
    relighter_free(&o->relighter);
    img *images[] = {&o->normal, &o->roughness, &o->depth, &o->reconstruction, &o->left, &o->right};
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++)
        img_free(images[i]);
}

/* Makes a picture whose sRGB code on the sheet is the value itself. */
static status show_values(const img *values, img *out)
{
    status s = img_copy(out, values);
    if (s != OK) return s;
    size_t count = (size_t)out->width * (size_t)out->height * (size_t)out->channels;
    for (size_t i = 0; i < count; i++)
        out->data[i] = srgb_decode(out->data[i]);
    return OK;
}

/* Resizes the reconstruction, with the exposure of the photograph next to it. */
static status show_reconstruction(const merlin_maps *maps, float white, img *out)
{
    img whole = maps->reconstruction, mask = maps->mask, part = {0};
    status s = crop_take(&whole, crop_of(maps), &mask, &part);
    if (s == OK) s = img_resize(&part, maps->size, maps->size, out);
    img_free(&part);
    size_t count = s == OK ? 3 * (size_t)maps->size * (size_t)maps->size : 0;
    for (size_t i = 0; i < count; i++)
        out->data[i] *= white / EXPOSURE_WHITE;
    return s;
}

static status make(network *n, const merlin_maps *maps, overview *o)
{
    status s = relighter_new(n, maps, maps->size, MERLIN_BY_BRDF, &o->relighter);
    if (s == OK && !maps->reconstruction.data)
        s = fail(MERLIN_WRONG_USE, "maps that were read from a folder have no reconstruction to show");
    if (s != OK) return s;
    /* an underexposed photograph is shown at the correct exposure */
    float white = o->relighter.white;
    o->relighter.white = EXPOSURE_WHITE;
    size_t count = 3 * (size_t)maps->size * (size_t)maps->size;
    for (size_t i = 0; i < count; i++)
        o->relighter.low_photo.data[i] /= EXPOSURE_WHITE;
    const surface *full = &o->relighter.full;
    s = figure_normals(&full->normal, &full->mask, &o->normal);
    if (s == OK) s = figure_depth(&full->depth, &full->mask, &o->depth);
    if (s == OK) s = show_values(&full->roughness, &o->roughness);
    if (s == OK) s = show_reconstruction(maps, white, &o->reconstruction);
    const lamp left = lamp_at(from_left), right = lamp_at(from_right);
    if (s == OK) s = relighter_render(n, &o->relighter, &left, 1, &o->left);
    if (s == OK) s = relighter_render(n, &o->relighter, &right, 1, &o->right);
    return s;
}

status overview_new(network *n, const merlin_maps *maps, overview *out)
{
    *out = (overview){0};
    status s = make(n, maps, out);
    if (s != OK) overview_free(out);
    return s;
}

void overview_tiles(const overview *o, figure_tile tiles[OVERVIEW_TILES])
{
    const figure_tile all[OVERVIEW_TILES] = {
        {"photograph", &o->relighter.low_photo},
        {"albedo", &o->relighter.full.albedo},
        {"normal", &o->normal},
        {"roughness", &o->roughness},
        {"depth", &o->depth},
        {"reconstruction", &o->reconstruction},
        {"light from the left", &o->left},
        {"light from the right", &o->right},
    };
    memcpy(tiles, all, sizeof all);
}
