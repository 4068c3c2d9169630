/* One pixel's surface from its values under many lights: Lambert's law plus one specular lobe, with cast shadows, light
 * from elsewhere and what the lobe does not explain as outliers.
 *
 *     pst_lobe_data data;
 *     pst_lobe_prepare(&observations, view, lobe.shadow, &data);
 *     pst_shading found = pst_lobe_fit(&data, &lobe);
 *
 * The radiance under a light l is  a max(0, n·l − τ) + s G(n·l) (1 + u (1 − (n·h)²))^−γ,  h half way between l and the
 * view. With γ = 2 this is the GGX distribution (u = 1/α² − 1; Walter et al. 2007); smaller γ has longer tails, γ = 8
 * is close to Beckmann's and to Blinn's cosine power. G(c) = c / (c (1 − k) + k) is Schlick's masking toward the light
 * (k = 1: a cosine). Fresnel's factor is constant to a percent for lights of the camera's side and goes into s. */
#ifndef MERLIN_STEREO_LOBE_FIT_H
#define MERLIN_STEREO_LOBE_FIT_H

#include <stdbool.h>

#include "stereo/pixel_fit.h"

/* What all pixels share. */
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

/* A value that is ordinary for the pixel: the median of those above a hundredth of its brightest. */
float pst_ordinary_level(const pst_observations *o);

/* view: unit, to the camera; shadow: what a shadow costs. */
void pst_lobe_prepare(const pst_observations *o, vec3 view, float shadow, pst_lobe_data *out);

/* The best of several starts: Lambert's fit, and the normal that the brightest observations mirror. */
pst_shading pst_lobe_fit(const pst_lobe_data *d, const pst_lobe *lobe);

/* The best of what was found and of starts all around, for a pixel that they did not serve. */
pst_shading pst_lobe_search(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *so_far);

/* The start of another lobe that looks most like a shading of the one. */
pst_shading pst_lobe_translate(const pst_lobe *from, const pst_lobe *to, const pst_shading *at);

/* The best near a start, or something that costs more than the limit, which is found sooner. */
pst_shading pst_lobe_refine(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *start, float limit);

/* weight gets each observation's share in the fit, in [0, 1], model what the fit makes of it. */
void pst_lobe_weigh(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *at, float *weight, float *model);

/* How far the fits to three quarters of the observations are from the quarter that each was not shown: the sum of the
 * residuals, each in [0, 1], shadows cheaper. Unlike the loss it grows with what is fitted to noise. */
float pst_lobe_foretell(const pst_observations *o, vec3 view, const pst_lobe *lobe);

#endif
