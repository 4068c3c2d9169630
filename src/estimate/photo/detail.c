/* SPDX-License-Identifier: MIT */
#include "estimate/photo/detail.h"

#include "estimate/photo/input.h"
#include "estimate/surface/fuse.h"
#include "image/resize.h"

/* Ratio of sizes below which detail counts as coarse. Normals are best with 16 (docs/notes/larger_pictures.md has their
 * errors with 4 to 32). */
enum { COARSE = 16 };

int detail_side(int size, int crop_side)
{
    int side = size < crop_side ? size : crop_side;
    side -= side % MODEL_SIZE_MULTIPLE;
    return side > NETWORK_SIZE ? side : 0;
}

int detail_views(int views)
{
    return (views + 1) / 2;
}

/* Computes the part of an image that a small picture of it contains, enlarged again. Pixels count with any coverage, as
 * whole parts may be thinner than half a pixel. */
static status coarse_part(const img *from, const img *mask, img *out)
{
    const int side = from->width / COARSE;
    img small_mask = {0}, small = {0};
    status s = img_resize(mask, side, side, &small_mask);
    for (size_t i = 0; s == OK && i < img_value_count(&small_mask); i++)
        small_mask.data[i] = small_mask.data[i] > 1e-3f;
    if (s == OK) s = surface_resize_image(from, mask, &small_mask, &small);
    if (s == OK) s = surface_resize_image(&small, &small_mask, mask, out);
    img_free(&small_mask);
    img_free(&small);
    return s;
}

status detail_fuse(const img *fine, const img *mask, img *normal)
{
    img error = {0}, correction = {0};
    status s = img_copy(&error, normal);
    for (size_t i = 0; s == OK && i < img_value_count(&error); i++)
        error.data[i] -= fine->data[i];
    if (s == OK) s = coarse_part(&error, mask, &correction);
    for (size_t i = 0; s == OK && i < img_value_count(normal); i++)
        normal->data[i] = fine->data[i] + correction.data[i];
    img_free(&error);
    img_free(&correction);
    return s;
}

/* Runs the network on the larger picture, and makes the guide that the coarse estimate needs afterwards. */
static status estimate_normals(network *n, const detail_request *r, img *guide, img *mask, img *normal)
{
    status s = input_make(r->photo, r->mask, r->side, guide, mask);
    if (s == OK) input_expose(guide, r->gain);
    if (s == OK) s = network_normals(n, guide, mask, r->how, r->views, r->stop, normal);
    if (s == OK) surface_encode_guide(guide, 1);
    return s;
}

status detail_add(network *n, const detail_request *r, surface *maps)
{
    img guide = {0}, mask = {0}, fine = {0};
    surface larger = {0};
    status s = estimate_normals(n, r, &guide, &mask, &fine);
    if (s == OK) s = surface_refine(maps, &guide, &mask, &larger);
    if (s == OK) s = detail_fuse(&fine, &mask, &larger.normal);
    if (s == OK) surface_tidy(&larger);
    if (s == OK) s = fuse_depth(&larger.normal, &larger.mask, surface_lens(&larger), &larger.depth);
    img_free(&guide);
    img_free(&mask);
    img_free(&fine);
    if (s != OK) {
        surface_free(&larger);
        return s;
    }
    surface_free(maps);
    *maps = larger;
    return OK;
}
