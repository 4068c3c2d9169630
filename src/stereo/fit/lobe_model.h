/* SPDX-License-Identifier: MIT */
/* The model of lobe.h at one light, without branches for loops over lights. Internal to the fit. */
#ifndef MERLIN_STEREO_FIT_LOBE_MODEL_H
#define MERLIN_STEREO_FIT_LOBE_MODEL_H

#include "base/number.h"
#include "stereo/fit/pixel_fit.h"

/* Clamps log u, from lobes wider than the hemisphere to mirrors. */
static inline float clamp_sharpness(float x)
{
    return clamp(x, -2.3f, 11);
}

/* Returns the cost of an observation far below the fit. */
static inline float charge(float shadowy, float value, float residual)
{
    return PST_IS_SHADOW(value, residual) ? 1 - shadowy : 1;
}

/* Selects the distribution by its argument x = sin² of the angle between n and h, without a branch: one of the three
 * powers has weight 1 (none for Lambert's law), and c = 1 − bend x turns the sine into the tangent. */
typedef struct tail_choice {
    float two, four, eight, bend;
} tail_choice;

static inline tail_choice choose_tail(int tail)
{
    return (tail_choice){tail == 2 ? 1 : 0, tail == 4 ? 1 : 0, tail == 8 ? 1 : 0, tail == 8 ? 0.999f : 0};
}

/* Returns base^(γ − 1). */
static inline float power_below(const tail_choice *t, float base)
{
    float two = base * base;
    return base * (t->two + two * (t->four + t->eight * (two * two)));
}

/* Returns the lobe, of height 1, at x and at the cosine to the light, with one division for distribution and masking.
 */
static inline float lobe_at(const tail_choice *t, float u, float x, float lit, float k)
{
    float c = 1 - t->bend * x, wide = c + u * x, mask = lit * (1 - k) + k + 1e-6f, both = 1 / (wide * mask);
    float base = c * both * mask;
    return base * power_below(t, base) * lit * both * wide;
}

#endif
