/* SPDX-License-Identifier: MIT */
/* A pixel's surface as Lambert's law plus one specular lobe, and its observations laid out for fits of that.
 *
 * The radiance under a light l is  a max(0, n·l − τ) + s G(n·l) (1 + u (1 − (n·h)²))^−γ,  h half way between l and the
 * view. With γ = 2 this is the GGX distribution (u = 1/α² − 1; Walter et al. 2007); smaller γ has longer tails, γ = 8
 * is close to Beckmann's and to Blinn's cosine power. G(c) = c / (c (1 − k) + k) is Schlick's masking toward the light
 * (k = 1: a cosine). Fresnel's factor is constant to a percent for lights of the camera's side and goes into s. */
#ifndef MERLIN_STEREO_FIT_LOBE_H
#define MERLIN_STEREO_FIT_LOBE_H

#include <stdbool.h>

#include "stereo/fit/pixel_fit.h"

/* The lobe's parameters, which all pixels share. */
typedef struct pst_lobe {
    int tail;         /* γ: 2, 4 or 8; 0: no lobe, Lambert's law alone */
    float width;      /* residuals far above this share of an ordinary value are outliers; 0.04 or more */
    float shadow;     /* what an observation costs that looks like a shadow; another outlier: 1 */
    float masking;    /* k */
    float terminator; /* τ */
    float focal;      /* pixels, of the camera under distant lights; 0: seen from afar */
} pst_lobe;

typedef struct pst_shading {
    vec3 normal;     /* unit */
    float albedo;    /* a */
    float gloss;     /* s */
    float sharpness; /* log u */
    float cost;      /* sum of the robust loss over the usable observations, each in [0, 1] */
    bool second;     /* of the two lobes that a field of pixels may have (field_fit.h) */
} pst_shading;

/* Two unit vectors that make a right-handed frame with a normal. */
static inline void pst_tangents(vec3 n, vec3 *t1, vec3 *t2)
{
    *t1 = vec3_normalize(fabsf(n.x) < 0.7f ? vec3_make(0, n.z, -n.y) : vec3_make(-n.z, 0, n.x));
    *t2 = vec3_cross(n, *t1);
}

typedef struct pst_lobe_data {
    pst_observations seen; /* borrowed */
    float level;           /* a value that is ordinary for the pixel; residuals are in its unit */
    float hx[PST_LIGHTS_ROOM], hy[PST_LIGHTS_ROOM], hz[PST_LIGHTS_ROOM];
    float shadowy[PST_LIGHTS_ROOM];   /* what less an observation costs if it is a shadow */
    float precision[PST_LIGHTS_ROOM]; /* usable / (level² + what the value is above it, squared) */
} pst_lobe_data;

#endif
