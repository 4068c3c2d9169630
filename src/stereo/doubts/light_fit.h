/* SPDX-License-Identifier: MIT */
/* Tells how a small version of a capture goes with a list of lights: the ground for telling whether the list is right.
 *
 *     pst_light_fit f;
 *     status s = pst_light_fit_new(capture, surface, &f);
 *     double left = pst_light_fit_unexplained(&f, f.light, -1);
 *     pst_light_fit_free(&f); */
#ifndef MERLIN_STEREO_DOUBTS_LIGHT_FIT_H
#define MERLIN_STEREO_DOUBTS_LIGHT_FIT_H

#include "stereo/integrate/stereo_surface.h"

enum { PST_CHECKED_PICTURES = 96 };

typedef struct pst_light_fit {
    merlin_capture small;              /* of the pictures that are looked at */
    int count;                         /* of these */
    int total;                         /* of the capture's lights */
    int picture[PST_CHECKED_PICTURES]; /* their numbers in the capture */
    float *strength;                   /* total: of the light, included in: */
    vec3 *light;                       /* total: toward the light, as long as it is strong at the object */
    double *gram;                      /* count × count: products of pictures, each pixel of the same weight */
    double energy;                     /* the gram's trace */
} pst_light_fit;

/* The surface's lights where it found some; near lights count as distant ones over the object's middle. */
status pst_light_fit_new(const merlin_capture *c, const merlin_surface *s, pst_light_fit *out);
void pst_light_fit_free(pst_light_fit *f);

/* The share of the pictures' energy that no Lambertian surface explains; light: one for each of the capture's
 * pictures. without: the number among those looked at of one that is left out, or -1. */
double pst_light_fit_unexplained(const pst_light_fit *f, const vec3 *light, int without);
/* The same of whichever three lights explain most. */
double pst_light_fit_least(const pst_light_fit *f, int without);

/* The surface at each pixel of the small pictures, outliers and shadows left out, whichever way it faces; 0 off the
 * object. */
void pst_light_fit_surface(const pst_light_fit *f, const vec3 *light, vec3 *b);

#endif
