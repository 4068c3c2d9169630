/* SPDX-License-Identifier: MIT */
#include "estimate/photo/compare.h"

#include "estimate/photo/input.h"
#include "estimate/surface/coarse.h"

/* Shares of the network's maps beside those of one that sees larger photographs one by one, by the number of
 * photographs: those of least error (docs/notes/several_photographs.md). */
static coarse_share share_of(int count)
{
    const float half = 0.5f, third = 0.3f;
    return count < 4 ? (coarse_share){third, third, half, third} : (coarse_share){half, half, 1, half};
}

static status compare(network *n, const photo_group *of, float (*lights)[MODEL_LIGHTS], surface *maps)
{
    network_estimation seen = {0};
    if (!maps || network_config(n)->only_lights)
        return network_lights_several(n, of->photos, of->count, of->mask, of->how, of->views, of->stop, lights);
    status s =
        network_estimate_several(n, of->photos, of->count, of->mask, of->how, of->views, of->stop, lights, &seen);
    if (s == OK) s = surface_take_coarse(&seen.maps, share_of(of->count), maps);
    network_estimation_free(&seen);
    return s;
}

status compare_photographs(network *n, const photo_group *of, float (*lights)[MODEL_LIGHTS], surface *maps)
{
    img photos[NN_LARGEST_GROUP] = {0}, mask = {0};
    const int side = of->mask->width < NETWORK_SEVERAL_SIZE ? of->mask->width : NETWORK_SEVERAL_SIZE;
    photo_group small = *of;
    status s = OK;
    if (of->count > NN_LARGEST_GROUP)
        return fail(MERLIN_WRONG_USE, "%d photographs of an object: 1 to %d", of->count, NN_LARGEST_GROUP);
    for (int i = 0; i < of->count && s == OK; i++) {
        img_free(&mask);
        s = input_make(&of->photos[i], of->mask, side, &photos[i], &mask);
    }
    small.photos = photos;
    small.mask = &mask;
    if (s == OK) s = compare(n, &small, lights, maps);
    for (int i = 0; i < of->count; i++)
        img_free(&photos[i]);
    img_free(&mask);
    return s;
}
