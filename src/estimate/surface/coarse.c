/* SPDX-License-Identifier: MIT */
#include "estimate/surface/coarse.h"

#include <math.h>

#include "base/number.h"

/* Ratios of albedos are limited to this and its inverse, and are those of values plus this. */
static const float most_ratio = 4, least_albedo = 0.01f;

static float ratio(float to, float from)
{
    return clamp((to + least_albedo) / (from + least_albedo), 1 / most_ratio, most_ratio);
}

static float difference(float to, float from)
{
    return to - from;
}

/* Two estimates of one map at the coarse size, and what is to change. */
typedef struct change {
    const img *to, *from, *mask; /* mask: of both */
    float share;
} change;

/* Enlarges what differs between the two. */
static status enlarge(const change *c, float (*differ)(float to, float from), const img *cover, img *out)
{
    img by = {0};
    status s = img_copy(&by, c->to);
    for (size_t i = 0; s == OK && i < img_value_count(&by); i++)
        by.data[i] = differ(c->to->data[i], c->from->data[i]);
    if (s == OK) s = surface_resize_image(&by, c->mask, cover, out);
    img_free(&by);
    return s;
}

static status add(change c, const img *cover, img *fine)
{
    img by = {0};
    status s = enlarge(&c, difference, cover, &by);
    for (size_t i = 0; s == OK && i < img_value_count(fine); i++)
        fine->data[i] += c.share * by.data[i];
    img_free(&by);
    return s;
}

static status multiply(change c, const img *cover, img *fine)
{
    img by = {0};
    status s = enlarge(&c, ratio, cover, &by);
    for (size_t i = 0; s == OK && i < img_value_count(fine); i++)
        if (fine->data[i] > 0) fine->data[i] *= powf(by.data[i], c.share);
    img_free(&by);
    return s;
}

status surface_take_coarse(const surface *coarse, coarse_share share, surface *fine)
{
    surface small = {0};
    const img *mask = &coarse->mask, *cover = &fine->mask;
    status s = surface_resize(fine, mask, &small);
    if (s == OK) s = multiply((change){&coarse->albedo, &small.albedo, mask, share.albedo}, cover, &fine->albedo);
    if (s == OK) s = add((change){&coarse->normal, &small.normal, mask, share.normal}, cover, &fine->normal);
    if (s == OK)
        s = add((change){&coarse->roughness, &small.roughness, mask, share.roughness}, cover, &fine->roughness);
    if (s == OK) s = add((change){&coarse->depth, &small.depth, mask, share.depth}, cover, &fine->depth);
    if (s == OK) surface_tidy(fine);
    surface_free(&small);
    return s;
}
