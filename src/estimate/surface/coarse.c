/* SPDX-License-Identifier: MIT */
#include "estimate/surface/coarse.h"

#include <math.h>

#include "base/number.h"

/* Ratios of albedos are limited to this and its inverse, and are those of values plus this. */
static const float most_ratio = 4, least_albedo = 0.01f;

/* A way to tell by what two values differ, and to change a third by a share of it. */
typedef struct way {
    float (*differ)(float to, float from);
    float (*apply)(float value, float by, float share);
} way;

static float ratio(float to, float from)
{
    return clamp((to + least_albedo) / (from + least_albedo), 1 / most_ratio, most_ratio);
}

static float multiply(float value, float by, float share)
{
    return value > 0 ? value * powf(by, share) : value;
}

static float difference(float to, float from)
{
    return to - from;
}

static float add(float value, float by, float share)
{
    return value + share * by;
}

static const way by_ratio = {ratio, multiply}, by_difference = {difference, add};

/* Two estimates of one map at the coarse size, their mask, and the share that is taken of what they differ. */
typedef struct change {
    const img *to, *from, *mask;
    float share;
} change;

static status apply(change c, const way *how, const img *cover, img *fine)
{
    img small = {0}, by = {0};
    status s = img_copy(&small, c.to);
    for (size_t i = 0; s == OK && i < img_value_count(&small); i++)
        small.data[i] = how->differ(c.to->data[i], c.from->data[i]);
    if (s == OK) s = surface_resize_image(&small, c.mask, cover, &by);
    for (size_t i = 0; s == OK && i < img_value_count(fine); i++)
        fine->data[i] = how->apply(fine->data[i], by.data[i], c.share);
    img_free(&small);
    img_free(&by);
    return s;
}

status surface_take_coarse(const surface *coarse, coarse_share share, surface *fine)
{
    surface small = {0};
    status s = surface_resize(fine, &coarse->mask, &small);
    const struct {
        change change;
        const way *how;
        img *fine;
    } maps[] = {
        {{&coarse->albedo, &small.albedo, &coarse->mask, share.albedo}, &by_ratio, &fine->albedo},
        {{&coarse->normal, &small.normal, &coarse->mask, share.normal}, &by_difference, &fine->normal},
        {{&coarse->roughness, &small.roughness, &coarse->mask, share.roughness}, &by_difference, &fine->roughness},
        {{&coarse->depth, &small.depth, &coarse->mask, share.depth}, &by_difference, &fine->depth}};
    for (size_t i = 0; i < sizeof maps / sizeof *maps && s == OK; i++)
        s = apply(maps[i].change, maps[i].how, &fine->mask, maps[i].fine);
    if (s == OK) surface_tidy(fine);
    surface_free(&small);
    return s;
}
