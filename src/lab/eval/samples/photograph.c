/* SPDX-License-Identifier: MIT */
#include "lab/eval/samples/photograph.h"

#include <math.h>
#include <stdlib.h>

#include "base/number.h"
#include "estimate/relight/maps_surface.h"
#include "estimate/surface/sight.h"
#include "image/resize.h"
#include "mesh/mesh.h"

/* Finds how large the photograph is. Where the sample's square lies beside the lens's axis it reaches as far to the
 * other side, to half a pixel, a tenth of a degree, for it has whole ones. */
static void find_frame(eval_photo *p)
{
    const int side = p->picture.width;
    const float pixels = (float)side / (2 * camera_tangent(p->lens.fov));
    const int right = (int)roundf(2 * p->lens.slant.right * pixels), up = (int)roundf(2 * p->lens.slant.up * pixels);
    p->width = side + abs(right);
    p->height = p->picture.height + abs(up);
    p->x = right > 0 ? right : 0;
    p->y = up < 0 ? -up : 0;
    const camera_slant at = p->lens.slant;
    const float focal = pixels * sqrtf(1 - at.right * at.right - at.up * at.up);
    const bool larger = right != 0 || up != 0;
    p->fov = p->params.fov = larger ? 2 * atanf((float)p->width / (2 * focal)) / DEGREE : p->lens.fov;
}

status eval_photo_take(const sample *s, const img *radiance, const img *mask, float white, eval_photo *out)
{
    *out = (eval_photo){.white = white, .lens = {s->fov, s->slant}, .params = merlin_params_default()};
    status st = img_copy(&out->picture, radiance);
    if (st == OK) st = img_copy(&out->mask, mask);
    if (st != OK) {
        eval_photo_free(out);
        return st;
    }
    for (size_t i = 0; i < img_value_count(radiance); i++)
        out->picture.data[i] = mask->data[i / 3] > 0 ? clamp(radiance->data[i] / white, 0, 1) : 0;
    find_frame(out);
    return OK;
}

void eval_photo_free(eval_photo *photo)
{
    img_free(&photo->picture);
    img_free(&photo->mask);
}

status eval_photo_estimate(merlin_model *model, const eval_photo *p, merlin_maps *maps)
{
    img picture = {0}, mask = {0};
    *maps = (merlin_maps){0};
    status s = img_crop(&p->picture, -p->x, -p->y, p->width, p->height, &picture);
    if (s == OK) s = img_crop(&p->mask, -p->x, -p->y, p->width, p->height, &mask);
    if (s == OK) s = merlin_estimate(model, &picture, &mask, &p->params, maps);
    img_free(&picture);
    img_free(&mask);
    return s;
}

/* ---- from the maps' camera to the sample's ---- */

/* Turns from the space of a camera that looks aside to that of the lens's axis. */
static mat3 to_axis(camera_slant at)
{
    const camera_plane p = camera_plane_of(at);
    return (mat3){{p.right, p.up, vec3_cross(p.right, p.up)}};
}

/* Tells where the crop's middle is, by the lens that was, whatever the estimate was told of it. */
static camera_slant crop_slant(const eval_photo *p, const merlin_maps *maps)
{
    return sight_of(p->fov, 0, p->width, p->height, crop_of(maps)).lens.slant;
}

vec3 eval_photo_from_maps(const eval_photo *p, const merlin_maps *maps, vec3 at)
{
    const mat3 crop = to_axis(crop_slant(p, maps)), own = to_axis(p->lens.slant);
    return mat3_apply_transposed(&own, mat3_apply(&crop, at));
}

vec3 eval_photo_to_maps(const eval_photo *p, const merlin_maps *maps, vec3 at)
{
    const mat3 crop = to_axis(crop_slant(p, maps)), own = to_axis(p->lens.slant);
    return mat3_apply_transposed(&crop, mat3_apply(&own, at));
}

/* Turns normals and points, row by row. */
static void turn_shape(const eval_photo *p, const merlin_maps *maps, surface *s)
{
    const int side = maps->crop.side, left = p->x - maps->crop.x, top = p->y - maps->crop.y;
    const camera_lens lens = {maps->fov > 0 ? maps->fov : CAMERA_FOV, {maps->slant[0], maps->slant[1]}};
    const camera seen = camera_through(lens, side, side);
    for (int y = 0; y < s->mask.height; y++)
        for (int x = 0; x < s->mask.width; x++) {
            if (!(*img_at(&s->mask, x, y) > 0)) continue;
            float *normal = img_at(&s->normal, x, y), *depth = img_at(&s->depth, x, y);
            vec3 point = camera_point(&seen, (float)(left + x) + 0.5f, (float)(top + y) + 0.5f, *depth);
            vec3_put(eval_photo_from_maps(p, maps, vec3_of(normal)), normal);
            *depth = -eval_photo_from_maps(p, maps, point).z;
        }
}

status eval_photo_cut(const eval_photo *p, const merlin_image *from, img *out)
{
    const img whole = *from;
    return img_crop(&whole, p->x, p->y, p->picture.width, p->picture.height, out);
}

status eval_photo_surface(const eval_photo *p, const merlin_maps *maps, surface *out)
{
    *out = (surface){.lens = p->lens};
    const camera_slant crop = crop_slant(p, maps);
    status s = eval_photo_cut(p, &maps->albedo, &out->albedo);
    if (s == OK) s = eval_photo_cut(p, &maps->normal, &out->normal);
    if (s == OK) s = eval_photo_cut(p, &maps->roughness, &out->roughness);
    if (s == OK) s = eval_photo_cut(p, &maps->depth, &out->depth);
    if (s == OK) s = eval_photo_cut(p, &maps->mask, &out->mask);
    if (s != OK) surface_free(out);
    const bool same = crop.right == p->lens.slant.right && crop.up == p->lens.slant.up;
    if (s == OK && !same) turn_shape(p, maps, out);
    return s;
}

status eval_photo_radiance(const eval_photo *p, const merlin_image *picture, img *out)
{
    status s = eval_photo_cut(p, picture, out);
    for (size_t i = 0; s == OK && i < img_value_count(out); i++)
        out->data[i] = fminf(p->white * out->data[i], 1);
    return s;
}
