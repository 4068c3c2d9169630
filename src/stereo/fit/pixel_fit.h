/* SPDX-License-Identifier: MIT */
/* One pixel's surface from its values under many lights, some of them highlights or cast shadows.
 *
 *     pst_observations o = {.padded = pst_padded(count), .x = x, .y = y, .z = z, .value = v, .usable = u};
 *     float weight[PST_MAX_LIGHTS];
 *     pst_pixel p = pst_pixel_fit(&o, weight);         p.b / |p.b| the normal, |p.b| the albedo
 *
 * Lights are shared between pixels (distant) or differ for each pixel (near). */
#ifndef MERLIN_STEREO_FIT_PIXEL_FIT_H
#define MERLIN_STEREO_FIT_PIXEL_FIT_H

#include "base/vec.h"

/* Vector length, and largest number of lights. Lengths are rounded up to whole vectors, so that loops over lights have
 * no remainder; the padding is not usable. */
enum { PST_LANES = 16, PST_MAX_LIGHTS = 1024 };

/* Spacing of arrays in memory: at a power of two all would map to the same few cache lines. */
enum { PST_LIGHTS_ROOM = PST_MAX_LIGHTS + PST_LANES };

/* Number of lights below which models beyond Lambert's law easily fit noise and errors of the lights. */
enum { PST_MANY_LIGHTS = 40 };

static inline int pst_padded(int count)
{
    return (count + PST_LANES - 1) / PST_LANES * PST_LANES;
}

/* Returns the length in a form that tells the compiler that loops need no code for a remainder. */
static inline int pst_whole(int padded)
{
    return padded / PST_LANES * PST_LANES;
}

/* Cost of a shadow, an observation below a quarter of the fit: less than that of other outliers, as most of a pixel's
 * observations may be shadows. */
#define PST_SHADOW_COST 0.1f
#define PST_IS_SHADOW(value, residual) (3 * (value) < -(residual))

typedef struct pst_observations {
    int padded;
    const float *x, *y, *z; /* unit direction to the light */
    const float *value;     /* radiance divided by the light's power here */
    const float *usable;    /* 1, or 0 if the picture has no value (saturated, padding) */
    float terminator;       /* τ: radiance is albedo · max(0, n·l − τ); 0 for Lambert's law */
} pst_observations;

typedef struct pst_pixel {
    vec3 b;     /* albedo times normal; 0 if nothing is usable */
    float cost; /* sum of the robust loss over the usable observations, each in [0, 1] */
} pst_pixel;

/* Fits a pixel; weight gets each observation's share in the fit, in [0, 1]. */
pst_pixel pst_pixel_fit(const pst_observations *o, float *weight);

#endif
