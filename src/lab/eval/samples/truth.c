/* SPDX-License-Identifier: MIT */
#include "lab/eval/samples/truth.h"

#include "base/number.h"
#include "base/rng.h"
#include "estimate/light/relight_env.h"
#include "lab/eval/metrics/metrics.h"

/* Apart from the streams that made the sample, so that lights are independent of the object. */
enum { STREAM_EVAL_LIGHT = 0x6576616c };

status eval_truth(const sample *s, const img *mask, surface *out)
{
    *out = (surface){.lens = {s->fov, s->slant}};
    status st = img_copy(&out->albedo, &s->albedo);
    if (st == OK) st = img_copy(&out->normal, &s->normal);
    if (st == OK) st = img_copy(&out->roughness, &s->roughness);
    if (st == OK) st = img_copy(&out->depth, &s->depth);
    if (st == OK) st = img_copy(&out->mask, mask);
    if (st != OK) surface_free(out);
    return st;
}

status eval_binary_mask(const img *coverage, img *out)
{
    status s = img_new(out, coverage->width, coverage->height, 1);
    if (s != OK) return s;
    for (size_t i = 0, n = img_value_count(out); i < n; i++)
        out->data[i] = coverage->data[i] > EVAL_MASK_LEVEL;
    return OK;
}

static void clip(img *picture, float exposure)
{
    for (size_t i = 0; i < img_value_count(picture); i++)
        picture->data[i] = clamp(exposure * picture->data[i], 0, 1);
}

status eval_render(const surface *maps, const illumination *light, float exposure, img *out)
{
    status s = surface_shade(maps, light->place, out);
    if (s != OK) return s;
    if (light->sh) surface_add_ambient(maps, light->sh, out);
    clip(out, exposure);
    return OK;
}

status eval_picture(const img *a, const img *b, const img *mask, img *out)
{
    status s = img_copy(out, a);
    if (s != OK) return s;
    for (size_t i = 0, n = img_value_count(out); i < n; i++)
        out->data[i] = mask->data[i / 3] > 0 ? clamp(a->data[i] + (b ? b->data[i] : 0), 0, 1) : 0;
    return OK;
}

vec3 eval_light(const sample *s, int i)
{
    rng r = rng_at(s->seed, s->index, STREAM_EVAL_LIGHT + (uint64_t)i);
    float u1 = rng_uniform(&r), u2 = rng_uniform(&r);
    return frontal_light(u1, u2);
}
