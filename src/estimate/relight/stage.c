/* SPDX-License-Identifier: MIT */
/* The maps of a crop at the size that is asked for, and made ready for many lights. */
#include <stdbool.h>

#include "estimate/api.h"
#include "estimate/photo/input.h"
#include "estimate/surface/exposure.h"
#include "image/resize.h"

/* Shadows are cast by maps of at most this side; a light costs a few hundredths of a second then. */
enum { CASTER_SIDE = 512 };

void stage_free(stage *s)
{
    surface_free(&s->full);
    surface_free(&s->low);
    img_free(&s->low_photo);
    network_look_free(s->look);
    s->look = NULL;
    img_free(&s->flash);
    shadow_caster_free(&s->caster);
    horizon_free(&s->horizon);
}

status maps_check(const merlin_maps *maps)
{
    enum { IMAGES = 7, RECONSTRUCTION = 6 };
    const merlin_image *images[IMAGES] = {&maps->albedo, &maps->normal, &maps->roughness,     &maps->depth,
                                          &maps->mask,   &maps->photo,  &maps->reconstruction};
    const int channels[IMAGES] = {3, 3, 1, 1, 1, 3, 3};
    int count = maps->reconstruction.data ? IMAGES : RECONSTRUCTION; /* which maps from a folder do not have */
    bool sound = crop_is_sound(crop_of(maps)) && maps->size >= NETWORK_LEAST_SIZE && maps->size <= NETWORK_SIZE &&
                 maps->size % MODEL_SIZE_MULTIPLE == 0 && exposure_is_sound(maps->gain);
    for (int i = 0; i < count; i++)
        sound &= images[i]->data && images[i]->channels == channels[i] && images[i]->width == maps->albedo.width &&
                 images[i]->height == maps->albedo.height;
    return sound ? OK : fail(MERLIN_WRONG_USE, "these maps are empty or incomplete");
}

static camera_lens lens_of(const merlin_maps *maps)
{
    return (camera_lens){maps->fov, {maps->slant[0], maps->slant[1]}};
}

static status crop_surface(const merlin_maps *maps, surface *out)
{
    const merlin_image *from[] = {&maps->albedo, &maps->normal, &maps->roughness, &maps->depth, &maps->mask};
    img *to[] = {&out->albedo, &out->normal, &out->roughness, &out->depth, &out->mask};
    status s = OK;
    img mask = maps->mask;
    for (int i = 0; i < 5 && s == OK; i++) {
        img whole = *from[i];
        s = crop_take(&whole, crop_of(maps), &mask, to[i]);
    }
    out->lens = lens_of(maps);
    if (s == OK) surface_tidy(out); /* anybody may have edited the maps */
    return s;
}

static status surface_at(const surface *from, int side, surface *out)
{
    img mask = {0};
    status s = img_resize(&from->mask, side, side, &mask);
    if (s == OK) harden_mask(NULL, &mask);
    if (s == OK) s = surface_resize(from, &mask, out);
    img_free(&mask);
    return s;
}

static status take_mask(const merlin_maps *maps, img *out)
{
    img whole = maps->mask;
    return crop_take(&whole, crop_of(maps), &whole, out);
}

/* One map of the crop at another size; mask: of the crop, and at the other size. */
static status take_map(const merlin_maps *maps, const merlin_image *map, const img *mask, const img *resized_mask,
                       img *out)
{
    img whole = *map, cover = maps->mask, part = {0};
    status s = crop_take(&whole, crop_of(maps), &cover, &part);
    if (s == OK) s = surface_resize_image(&part, mask, resized_mask, out);
    img_free(&part);
    return s;
}

/* A map after the other: those of a large photograph would fill the memory side by side. */
static status take_surface(const merlin_maps *maps, const img *mask, int side, bool hard, surface *out)
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
    if (s == OK) s = take_mask(maps, &mask);
    if (s == OK) s = take_surface(maps, &mask, side, true, out);
    img_free(&mask);
    if (s != OK) surface_free(out);
    return s;
}

status maps_albedo(const merlin_maps *maps, int side, img *out)
{
    *out = (img){0};
    img mask = {0}, resized = {0};
    status s = maps_check(maps);
    if (s == OK) s = take_mask(maps, &mask);
    if (s == OK) s = img_resize(&mask, side, side, &resized);
    if (s == OK) s = take_map(maps, &maps->albedo, &mask, &resized, out);
    img_free(&mask);
    img_free(&resized);
    return s;
}

/* The photograph as the network saw it. */
static status take_low_photo(const merlin_maps *maps, img *mask, img *out)
{
    img whole = maps->photo, cover = maps->mask, part = {0};
    status s = crop_take(&whole, crop_of(maps), &cover, &part);
    if (s == OK) s = img_resize(&part, maps->size, maps->size, out);
    img_free(&part);
    if (s != OK) return s;
    harden_mask(out, mask);
    input_expose(out, maps->gain);
    return OK;
}

/* Of the maps as the network gave them: the photograph's resolution adds nothing to their shape. */
static status caster_of(const surface *low, shadow_caster *out)
{
    surface less = {0};
    bool large = low->mask.width > CASTER_SIDE;
    status s = large ? surface_at(low, CASTER_SIDE, &less) : OK;
    const surface *from = large ? &less : low;
    if (s == OK) s = shadow_caster_new(&from->depth, &from->normal, &from->mask, surface_lens(from), out);
    surface_free(&less);
    return s;
}

static status take_full(const merlin_maps *maps, const img *mask, int side, surface *out)
{
    bool as_photographed = side == 0 || side == maps->crop.side;
    return as_photographed ? crop_surface(maps, out) : take_surface(maps, mask, side, false, out);
}

status stage_resize(stage *s, const merlin_maps *maps, int side)
{
    img mask = {0};
    bool matte = s->full.matte;
    surface_free(&s->full);
    status result = maps_check(maps);
    if (result == OK) result = take_mask(maps, &mask);
    if (result == OK) result = take_full(maps, &mask, side, &s->full);
    s->full.matte = matte;
    img_free(&mask);
    return result;
}

/* What the network saw, and what every light wants of it. */
static status take_low(network *n, const merlin_maps *maps, const img *mask, stage *s)
{
    status result = take_surface(maps, mask, maps->size, true, &s->low);
    if (result == OK) result = take_low_photo(maps, &s->low.mask, &s->low_photo);
    if (result == OK) result = surface_shade(&s->low, vec3_make(0, 0, 0), &s->flash);
    if (result == OK && s->how == MERLIN_BY_NETWORK)
        result = network_look_new(n, &s->low_photo, &s->low.mask, &(sight){.lens = s->low.lens}, &s->look);
    if (result == OK && s->how == MERLIN_BY_BRDF) result = caster_of(&s->low, &s->caster);
    return result;
}

status stage_new(network *n, const merlin_maps *maps, int side, merlin_relighting how, stage *out)
{
    *out = (stage){.how = how};
    img mask = {0}, photo = maps->photo;
    status s = maps_check(maps);
    if (s == OK) out->white = exposure_white(&photo, maps->gain);
    if (s == OK) s = take_mask(maps, &mask);
    if (s == OK) s = take_low(n, maps, &mask, out);
    if (s == OK) s = take_full(maps, &mask, side, &out->full);
    img_free(&mask);
    if (s != OK) stage_free(out);
    return s;
}

status stage_make_matte(stage *s)
{
    s->full.matte = s->low.matte = true;
    img_free(&s->flash);
    return surface_shade(&s->low, vec3_make(0, 0, 0), &s->flash);
}

status stage_surround(stage *s, const env_map *environment)
{
    s->environment = environment;
    bool first = environment && s->how == MERLIN_BY_BRDF && !s->horizon.closed;
    return first ? horizon_new(&s->caster, &s->horizon) : OK;
}
