/* SPDX-License-Identifier: MIT */
#include "photo_stereo/refit_depth.h"

#include <math.h>

#include "estimate/relight/maps_surface.h"
#include "estimate/surface/fuse.h"
#include "stereo/capture/shrink.h"
#include "stereo/integrate/integrate.h"

/* Makes the mask 0 or 1. Returns the object's pixels and the mean of its depths. */
static size_t harden(surface *part, float *mean)
{
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < img_value_count(&part->mask); i++) {
        part->mask.data[i] = part->mask.data[i] >= 0.5f;
        sum += part->mask.data[i] > 0 ? (double)part->depth.data[i] : 0;
        count += part->mask.data[i] > 0;
    }
    *mean = count > 0 ? (float)(sum / (double)count) : 1;
    return count;
}

static status integrate_blocks(const surface *part, const pinhole *whole, int factor, img *depth)
{
    const pst_blocks blocks = {.columns = (part->mask.width + factor - 1) / factor,
                               .rows = (part->mask.height + factor - 1) / factor,
                               .factor = factor};
    const float smaller = 1 / (float)factor;
    const pinhole seen_by = {whole->focal * smaller, whole->x * smaller, whole->y * smaller, whole->distance};
    img normal = {0}, mask = {0}, coarse = {0};
    status s = pst_shrink_map(&part->normal, &part->mask, blocks, &normal);
    if (s == OK) s = pst_shrink_map(&part->mask, &part->mask, blocks, &mask);
    if (s == OK) s = pst_integrate(&normal, &mask, &seen_by, &(pst_integration){.preserve_edges = false}, &coarse);
    if (s == OK) s = img_new(depth, part->mask.width, part->mask.height, 1);
    if (s == OK) pst_enlarge(&coarse, &mask, &part->mask, factor, depth);
    img_free(&normal);
    img_free(&mask);
    img_free(&coarse);
    return s;
}

/* Integrates normals as of a lens whose axis goes through the crop's middle. */
static status integrate(surface *part, size_t most)
{
    const int side = part->mask.width;
    pinhole seen_by = pinhole_of(side, side, (float)surface_lens(part).fov);
    img depth = {0};
    const size_t count = harden(part, &seen_by.distance);
    const int factor = count > most ? (int)ceil(sqrt((double)count / (double)most)) : 1;
    img_free(&part->depth);
    status s = factor > 1 ? integrate_blocks(part, &seen_by, factor, &depth)
                          : pst_integrate(&part->normal, &part->mask, &seen_by,
                                          &(pst_integration){.preserve_edges = false}, &depth);
    part->depth = depth;
    return s;
}

status refit_surface_depth(surface *part, size_t most)
{
    status s = integrate(part, most);
    return s == OK ? fuse_depth(&part->normal, &part->mask, surface_lens(part), &part->depth) : s;
}

status refit_depth(merlin_maps *maps)
{
    surface part = {0};
    status s = maps_shape_as_photographed(maps, &part);
    if (s == OK) s = refit_surface_depth(&part, REFIT_INTEGRATED);
    if (s == OK) crop_put(&part.depth, crop_of(maps), &part.mask, &maps->depth);
    surface_free(&part);
    return s;
}
