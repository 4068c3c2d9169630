/* SPDX-License-Identifier: MIT */
#include "estimate/relight/maps_surface.h"

#include <stdbool.h>

#include "estimate/object/mask.h"
#include "estimate/photo/input.h"
#include "estimate/photo/network.h"
#include "estimate/surface/exposure.h"
#include "image/resize.h"

status maps_check(const merlin_maps *maps)
{
    enum { IMAGES = 8, NEEDED = 6 }; /* maps from a folder have no reconstruction, those of one photograph no spread */
    const merlin_image *images[IMAGES] = {&maps->albedo, &maps->normal, &maps->roughness,      &maps->depth,
                                          &maps->mask,   &maps->photo,  &maps->reconstruction, &maps->spread};
    const int channels[IMAGES] = {3, 3, 1, 1, 1, 3, 3, 1};
    bool sound = crop_is_sound(crop_of(maps)) && maps->size >= NETWORK_LEAST_SIZE && maps->size <= NETWORK_SIZE &&
                 maps->size % MODEL_SIZE_MULTIPLE == 0 && exposure_is_sound(maps->gain);
    for (int i = 0; i < IMAGES; i++)
        sound &= (i >= NEEDED && !images[i]->data) ||
                 (images[i]->data && images[i]->channels == channels[i] && images[i]->width == maps->albedo.width &&
                  images[i]->height == maps->albedo.height);
    return sound ? OK : fail(MERLIN_WRONG_USE, "these maps are empty or incomplete");
}

static camera_lens lens_of(const merlin_maps *maps)
{
    return (camera_lens){maps->fov, {maps->slant[0], maps->slant[1]}};
}

status maps_shape_as_photographed(const merlin_maps *maps, surface *out)
{
    const crop_square crop = crop_of(maps);
    out->lens = lens_of(maps);
    status s = crop_take(&maps->normal, crop, &maps->mask, &out->normal);
    if (s == OK) s = crop_take(&maps->depth, crop, &maps->mask, &out->depth);
    return s == OK ? crop_take(&maps->mask, crop, &maps->mask, &out->mask) : s;
}

status maps_as_photographed(const merlin_maps *maps, surface *out)
{
    const crop_square crop = crop_of(maps);
    status s = maps_shape_as_photographed(maps, out);
    if (s == OK) s = crop_take(&maps->albedo, crop, &maps->mask, &out->albedo);
    if (s == OK) s = crop_take(&maps->roughness, crop, &maps->mask, &out->roughness);
    if (s == OK) surface_tidy(out); /* the maps may have been edited */
    return s;
}

status maps_take_mask(const merlin_maps *maps, img *out)
{
    img whole = maps->mask;
    return crop_take(&whole, crop_of(maps), &whole, out);
}

/* Resizes one map of the crop; mask: of the crop, and at the new size. */
static status take_map(const merlin_maps *maps, const merlin_image *map, const img *mask, const img *resized_mask,
                       img *out)
{
    img whole = *map, cover = maps->mask, part = {0};
    status s = crop_take(&whole, crop_of(maps), &cover, &part);
    if (s == OK) s = surface_resize_image(&part, mask, resized_mask, out);
    img_free(&part);
    return s;
}

/* Takes one map after the other, as all those of a large photograph at once would take much memory. */
status maps_take_surface(const merlin_maps *maps, const img *mask, int side, bool hard, surface *out)
{
    const merlin_image *from[] = {&maps->albedo, &maps->normal, &maps->roughness, &maps->depth};
    img *to[] = {&out->albedo, &out->normal, &out->roughness, &out->depth};
    out->lens = lens_of(maps);
    status s = img_resize(mask, side, side, &out->mask);
    if (s == OK && hard) harden_mask(NULL, &out->mask);
    if (s == OK && side > mask->width) mask_clean(&out->mask);
    for (int i = 0; i < 4 && s == OK; i++)
        s = take_map(maps, from[i], mask, &out->mask, to[i]);
    if (s == OK) surface_tidy(out);
    return s;
}

status maps_surface(const merlin_maps *maps, int side, surface *out)
{
    *out = (surface){0};
    img mask = {0};
    status s = maps_check(maps);
    if (s == OK) s = maps_take_mask(maps, &mask);
    if (s == OK) s = maps_take_surface(maps, &mask, side, true, out);
    img_free(&mask);
    if (s != OK) surface_free(out);
    return s;
}

status maps_albedo(const merlin_maps *maps, int side, img *out)
{
    *out = (img){0};
    img mask = {0}, resized = {0};
    status s = maps_check(maps);
    if (s == OK) s = maps_take_mask(maps, &mask);
    if (s == OK) s = img_resize(&mask, side, side, &resized);
    if (s == OK) s = take_map(maps, &maps->albedo, &mask, &resized, out);
    img_free(&mask);
    img_free(&resized);
    return s;
}
