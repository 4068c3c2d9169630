/* SPDX-License-Identifier: MIT */
#include "lab/eval/maps.h"

#include <string.h>

#include "base/parallel.h"
#include "base/rng.h"
#include "lab/eval/metrics.h"
#include "optics/camera.h"
#include "optics/sh.h"

/* Apart from the streams that made the sample, so that lights are independent of the object. */
enum { STREAM_EVAL_LIGHT = 0x6576616c };

status eval_maps_new(eval_maps *out, int width, int height)
{
    *out = (eval_maps){0};
    status s = img_new(&out->albedo, width, height, 3);
    if (s == OK) s = img_new(&out->normal, width, height, 3);
    if (s == OK) s = img_new(&out->roughness, width, height, 1);
    if (s == OK) s = img_new(&out->depth, width, height, 1);
    if (s != OK) eval_maps_free(out);
    return s;
}

void eval_maps_free(eval_maps *maps)
{
    img_free(&maps->albedo);
    img_free(&maps->normal);
    img_free(&maps->roughness);
    img_free(&maps->depth);
}

void eval_to_file_range(img *map)
{
    for (size_t i = 0, n = img_value_count(map); i < n; i++)
        map->data[i] = (map->data[i] + 1) / 2;
}

void eval_to_network_range(img *map)
{
    for (size_t i = 0, n = img_value_count(map); i < n; i++)
        map->data[i] = 2 * map->data[i] - 1;
}

static void take(const img *from, img *to)
{
    memcpy(to->data, from->data, img_value_count(to) * sizeof *to->data);
}

void eval_maps_take(const eval_maps *from, int set, eval_maps *to)
{
    if (set & EVAL_GIVEN_ALBEDO) take(&from->albedo, &to->albedo);
    if (set & EVAL_GIVEN_NORMAL) take(&from->normal, &to->normal);
    if (set & EVAL_GIVEN_ROUGHNESS) take(&from->roughness, &to->roughness);
    if (set & EVAL_GIVEN_DEPTH) take(&from->depth, &to->depth);
}

status eval_maps_of_sample(const sample *s, eval_maps *out)
{
    *out = (eval_maps){0};
    status st = img_copy(&out->albedo, &s->albedo);
    if (st == OK) st = img_copy(&out->normal, &s->normal);
    if (st == OK) st = img_copy(&out->roughness, &s->roughness);
    if (st == OK) st = img_copy(&out->depth, &s->depth);
    if (st != OK) {
        eval_maps_free(out);
        return st;
    }
    eval_to_network_range(&out->albedo);
    eval_to_network_range(&out->roughness);
    return OK;
}

void eval_make_unit(img *normal)
{
    for (size_t i = 0, n = (size_t)normal->width * (size_t)normal->height; i < n; i++)
        vec3_put(vec3_normalize(vec3_of(normal->data + 3 * i)), normal->data + 3 * i);
}

typedef struct render_work {
    const eval_maps *maps;
    const img *mask;
    camera view;
    float power;
    const illumination *light;
    img *out;
} render_work;

static vec3 clip(vec3 c)
{
    return vec3_make(brdf_clamp(c.x, 0, 1), brdf_clamp(c.y, 0, 1), brdf_clamp(c.z, 0, 1));
}

static void render_row(void *context, size_t row)
{
    const render_work *w = context;
    int y = (int)row;
    for (int x = 0; x < w->mask->width; x++) {
        float inside = *img_at(w->mask, x, y);
        if (!(inside > 0)) continue;
        const float *a = img_at(&w->maps->albedo, x, y), *n = img_at(&w->maps->normal, x, y);
        shade_input in = {
            .albedo = {(a[0] + 1) / 2, (a[1] + 1) / 2, (a[2] + 1) / 2},
            .roughness = (*img_at(&w->maps->roughness, x, y) + 1) / 2,
            .normal = {n[0], n[1], n[2]},
            .depth = *img_at(&w->maps->depth, x, y),
            .ray = camera_point(&w->view, (float)x + 0.5f, (float)y + 0.5f, 1),
            .light = w->light->place,
            .power = w->power,
        };
        vec3 radiance = clip(shade_point(&in));
        if (w->light->sh) {
            vec3 white = vec3_scale(sh_irradiance(w->light->sh, in.normal), 1 / BRDF_PI);
            radiance = clip(vec3_add(radiance, vec3_mul(in.albedo, white)));
        }
        radiance = vec3_scale(radiance, inside);
        vec3_put(radiance, img_at(w->out, x, y));
    }
}

status eval_render(const eval_maps *maps, const img *mask, float fov, float power, const illumination *light, img *out)
{
    status s = img_new(out, mask->width, mask->height, 3);
    if (s != OK) return s;
    render_work w = {maps, mask, {.width = mask->width, .height = mask->height, .fov = fov}, power, light, out};
    parallel_for((size_t)mask->height, render_row, &w);
    return OK;
}

status eval_binary_mask(const img *coverage, img *out)
{
    status s = img_new(out, coverage->width, coverage->height, 1);
    if (s != OK) return s;
    for (size_t i = 0, n = img_value_count(out); i < n; i++)
        out->data[i] = coverage->data[i] > EVAL_MASK_LEVEL;
    return OK;
}

status eval_picture(const img *a, const img *b, const img *mask, img *out)
{
    return eval_photograph(a, b, mask, 1, out);
}

status eval_photograph(const img *a, const img *b, const img *mask, float white, img *out)
{
    status s = img_copy(out, a);
    if (s != OK) return s;
    for (size_t i = 0, n = img_value_count(out); i < n; i++)
        out->data[i] = brdf_clamp(a->data[i] + (b ? b->data[i] : 0), 0, white) * mask->data[i / 3];
    return OK;
}

vec3 eval_light(const sample *s, int i)
{
    rng r = rng_at(s->seed, s->index, STREAM_EVAL_LIGHT + (uint64_t)i);
    float u1 = rng_uniform(&r), u2 = rng_uniform(&r);
    return frontal_light(u1, u2);
}
