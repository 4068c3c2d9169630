/* SPDX-License-Identifier: MIT */
/* Measures how well a list of lights explains a small version of a capture, to find out whether the list is right.
 *
 *     pst_light_fit f;
 *     status s = pst_light_fit_new(capture, surface, &f);
 *     double left = pst_light_fit_unexplained(&f, f.light, -1);
 *     pst_light_fit_free(&f);
 */
#ifndef MERLIN_STEREO_DOUBTS_LIGHT_FIT_H
#define MERLIN_STEREO_DOUBTS_LIGHT_FIT_H

#include "stereo/integrate/stereo_surface.h"

enum { PST_CHECKED_PICTURES = 96 };

typedef struct pst_light_fit {
    merlin_capture small;              /* the pictures that are used */
    int count;                         /* their number */
    int total;                         /* number of the capture's lights */
    int picture[PST_CHECKED_PICTURES]; /* their indices in the capture */
    float *strength;                   /* total: strength of the light, included in: */
    vec3 *light;                       /* total: vector toward the light, with its strength at the object as length */
    double *gram;                      /* count × count: products of pictures, with the same weight for each pixel */
    double energy;                     /* trace of the gram matrix; 0: the pictures are too dark to tell */
} pst_light_fit;

/* Prepares the fit. Lights found with the surface are used if there are any; near lights count as distant ones above
 * the object's middle. */
status pst_light_fit_new(const merlin_capture *c, const merlin_surface *s, pst_light_fit *out);
void pst_light_fit_free(pst_light_fit *f);

/* Returns the share of the pictures' energy that no Lambertian surface explains; light: one for each of the capture's
 * pictures. without: index of a picture among those used that is left out, or -1. */
double pst_light_fit_unexplained(const pst_light_fit *f, const vec3 *light, int without);
/* Returns the same for the three lights that explain most. */
double pst_light_fit_least(const pst_light_fit *f, int without);

/* Computes the surface at each pixel of the small pictures without outliers and shadows, facing either way; 0 outside
 * the object. */
void pst_light_fit_surface(const pst_light_fit *f, const vec3 *light, vec3 *b);

#endif
