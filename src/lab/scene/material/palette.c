/* SPDX-License-Identifier: MIT */
#include "lab/scene/material/palette.h"

#include <stdbool.h>

#include "base/number.h"
#include "image/color.h"

static float channel(float hue, float saturation, float value, float offset)
{
    float k = fmodf(offset + 6 * hue, 6), ramp = clamp(min_of(k, 4 - k), 0, 1);
    return clamp(srgb_decode(value * (1 - saturation * ramp)), 0.01f, 0.95f);
}

vec3 colour_hsv(float hue, float saturation, float value)
{
    hue -= floorf(hue);
    return vec3_make(channel(hue, saturation, value, 5), channel(hue, saturation, value, 3),
                     channel(hue, saturation, value, 1));
}

/* Returns a random colour between two, given as hue, saturation and value. */
static vec3 between(rng *r, vec3 low, vec3 high)
{
    float hue = rng_range(r, low.x, high.x), saturation = rng_range(r, low.y, high.y),
          value = rng_range(r, low.z, high.z);
    return colour_hsv(hue, saturation, value);
}

/* Returns a colour of wood, clay, stone, leaves or leather: orange to green of low saturation. */
static vec3 natural(rng *r)
{
    return between(r, (vec3){0.01f, 0.08f, 0.25f}, (vec3){0.3f, 0.6f, 0.92f});
}

/* Returns a colour of paint, most often red to yellow. */
static vec3 painted(rng *r)
{
    bool warm = rng_uniform(r) < 0.4f;
    return between(r, (vec3){warm ? -0.04f : 0, 0.6f, 0.35f}, (vec3){warm ? 0.17f : 1, 1, 1});
}

static vec3 pale(rng *r)
{
    return between(r, (vec3){0, 0, 0.75f}, (vec3){1, 0.12f, 0.98f});
}

static vec3 dark(rng *r)
{
    return between(r, (vec3){0, 0, 0.05f}, (vec3){1, 0.6f, 0.25f});
}

static vec3 grey(rng *r)
{
    return between(r, (vec3){0, 0, 0.2f}, (vec3){1, 0.15f, 0.8f});
}

static vec3 anything(rng *r)
{
    return between(r, (vec3){0, 0, 0.1f}, (vec3){1, 1, 1});
}

void palette_random(rng *r, vec3 colour[PALETTE])
{
    typedef vec3 (*maker)(rng *);
    static const maker THEMES[][4] = {
        {natural, natural, natural, pale},        {painted, painted, painted, pale},
        {pale, painted, dark, painted},           {pale, pale, natural, dark},
        {anything, anything, anything, anything}, {dark, grey, painted, pale},
        {natural, painted, dark, pale},           {grey, grey, natural, pale},
    };
    const maker *theme = THEMES[rng_below(r, (int)(sizeof THEMES / sizeof *THEMES))];
    float hue = rng_uniform(r), saturation = rng_uniform(r);
    bool one_hue = rng_uniform(r) < 0.18f;
    for (int i = 0; i < PALETTE; i++) {
        colour[i] = i == 0 ? theme[0](r) : theme[rng_below(r, 4)](r);
        if (one_hue) {
            float low = min_of(1, 0.6f * saturation), high = min_of(1, 1.2f * saturation);
            colour[i] = between(r, (vec3){hue - 0.04f, low, 0.1f}, (vec3){hue + 0.04f, high, 0.97f});
        }
    }
}
