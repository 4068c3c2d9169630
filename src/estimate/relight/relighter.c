/* SPDX-License-Identifier: MIT */
#include <stdbool.h>

#include "estimate/relight/relighter.h"

#include "estimate/photo/input.h"
#include "estimate/relight/maps_surface.h"
#include "estimate/surface/exposure.h"
#include "image/resize.h"

/* Largest side of the maps that cast shadows, so that a light takes a few hundredths of a second. */
enum { OCCLUDER_SIDE = 512 };

void relighter_free(relighter *s)
{
    surface_free(&s->full);
    surface_free(&s->low);
    img_free(&s->low_photo);
    network_features_free(s->features);
    s->features = NULL;
    img_free(&s->flash);
    shadow_occluder_free(&s->occluder);
    horizon_free(&s->horizon);
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

/* Makes the photograph as the network saw it. */
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

/* Makes the occluder from the network's own maps, as the photograph's resolution adds nothing to their shape. */
static status occluder_of(const surface *low, shadow_occluder *out)
{
    surface less = {0};
    bool large = low->mask.width > OCCLUDER_SIDE;
    status s = large ? surface_at(low, OCCLUDER_SIDE, &less) : OK;
    const surface *from = large ? &less : low;
    if (s == OK) s = shadow_occluder_new(&from->depth, &from->normal, &from->mask, surface_lens(from), out);
    surface_free(&less);
    return s;
}

static status take_full(const merlin_maps *maps, const img *mask, int side, surface *out)
{
    bool as_photographed = side == 0 || side == maps->crop.side;
    return as_photographed ? maps_as_photographed(maps, out) : maps_take_surface(maps, mask, side, false, out);
}

status relighter_resize(relighter *s, const merlin_maps *maps, int side)
{
    img mask = {0};
    bool matte = s->full.matte;
    surface_free(&s->full);
    status result = maps_check(maps);
    if (result == OK) result = maps_take_mask(maps, &mask);
    if (result == OK) result = take_full(maps, &mask, side, &s->full);
    s->full.matte = matte;
    img_free(&mask);
    return result;
}

/* Makes what the network saw, and what all lights need of it. */
static status take_low(network *n, const merlin_maps *maps, const img *mask, relighter *s)
{
    status result = maps_take_surface(maps, mask, maps->size, true, &s->low);
    s->low.matte = maps->captured;
    if (result == OK) result = take_low_photo(maps, &s->low.mask, &s->low_photo);
    if (result == OK) result = surface_shade(&s->low, vec3_make(0, 0, 0), &s->flash);
    if (result == OK && s->how == MERLIN_BY_NETWORK)
        result = network_features_new(n, &s->low_photo, &s->low.mask, &(sight){.lens = s->low.lens}, NETWORK_VIEWS,
                                      &s->features);
    if (result == OK && relighter_casts_shadows(s)) result = occluder_of(&s->low, &s->occluder);
    return result;
}

status relighter_new(network *n, const merlin_maps *maps, int side, merlin_relighting how, relighter *out)
{
    *out = (relighter){.how = how};
    img mask = {0}, photo = maps->photo;
    status s = maps_check(maps);
    if (s == OK && maps->captured && how == MERLIN_BY_NETWORK)
        s = fail(MERLIN_WRONG_USE,
                 "the relighting decoder wants a photograph, and these maps are a captured surface's");
    if (s == OK) out->white = exposure_white(&photo, maps->gain);
    if (s == OK) s = maps_take_mask(maps, &mask);
    if (s == OK) s = take_low(n, maps, &mask, out);
    if (s == OK) s = take_full(maps, &mask, side, &out->full);
    out->full.matte = maps->captured;
    img_free(&mask);
    if (s != OK) relighter_free(out);
    return s;
}

status relighter_make_matte(relighter *s)
{
    s->full.matte = s->low.matte = true;
    img_free(&s->flash);
    return surface_shade(&s->low, vec3_make(0, 0, 0), &s->flash);
}

status relighter_surround(relighter *s, const env_map *environment)
{
    s->environment = environment;
    bool first = environment && relighter_casts_shadows(s) && !s->horizon.closed;
    return first ? horizon_new(&s->occluder, &s->horizon) : OK;
}
