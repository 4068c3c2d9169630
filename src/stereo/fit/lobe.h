/* SPDX-License-Identifier: MIT */
/* A pixel's surface by Lambert's law plus one specular lobe, and its observations prepared for fits of that.
 *
 * The radiance under a light l is  a max(0, n·l − τ) + s G(n·l) (1 + u (1 − (n·h)²))^−γ,  with h half way between l and
 * the view. With γ = 2 this is the GGX distribution (u = 1/α² − 1; Walter et al. 2007); smaller γ has longer tails, γ =
 * 8 is close to Beckmann's and to Blinn's cosine power. G(c) = c / (c (1 − k) + k) is Schlick's masking toward the
 * light (k = 1: a cosine). Fresnel's factor is constant within a percent for lights on the camera's side, and is part
 * of s. */
#ifndef MERLIN_STEREO_FIT_LOBE_H
#define MERLIN_STEREO_FIT_LOBE_H

#include <stdbool.h>

#include "stereo/fit/pixel_fit.h"

/* Parameters of the lobe that all pixels share. */
typedef struct pst_lobe {
    int tail;         /* γ: 2, 4 or 8; 0: no lobe, Lambert's law only */
    float width;      /* residuals far above this share of an ordinary value are outliers; 0.04 or more */
    float shadow;     /* cost of an observation that looks like a shadow; of another outlier: 1 */
    float masking;    /* k */
    float terminator; /* τ */
    float focal;      /* focal length in pixels of the camera under distant lights; 0: orthographic */
} pst_lobe;

typedef struct pst_shading {
    vec3 normal;     /* unit vector */
    float albedo;    /* a */
    float gloss;     /* s */
    float sharpness; /* log u */
    float cost;      /* sum of the robust loss over the usable observations, each in [0, 1] */
    bool second;     /* whether it is the second of the two lobes that a field of pixels may have (field_fit.h) */
} pst_shading;

/* Makes two unit vectors that form a right-handed frame with a normal. */
static inline void pst_tangents(vec3 n, vec3 *t1, vec3 *t2)
{
    *t1 = vec3_normalize(fabsf(n.x) < 0.7f ? vec3_make(0, n.z, -n.y) : vec3_make(-n.z, 0, n.x));
    *t2 = vec3_cross(n, *t1);
}

typedef struct pst_lobe_data {
    pst_observations seen; /* borrowed */
    float level;           /* ordinary value of the pixel, the unit of residuals */
    float hx[PST_LIGHTS_ROOM], hy[PST_LIGHTS_ROOM], hz[PST_LIGHTS_ROOM];
    float shadowy[PST_LIGHTS_ROOM];   /* reduction of an observation's cost if it is a shadow */
    float precision[PST_LIGHTS_ROOM]; /* usable / (level² + the square of the value's excess over it) */
} pst_lobe_data;

#endif
