/* SPDX-License-Identifier: MIT */
/* The surface that photometric stereo finds, and the method that found it. */
#ifndef MERLIN_STEREO_INTEGRATE_SURFACE_H
#define MERLIN_STEREO_INTEGRATE_SURFACE_H

#include "stereo/capture/capture.h"

typedef enum pst_method {
    PST_AUTO,
    PST_LS,          /* Lambertian least squares (Woodham 1980), shadows and saturation left out */
    PST_ROBUST,      /* a specular lobe a pixel; cast shadows as outliers */
    PST_NEAR_LIGHTS, /* near point lights, perspective camera, alternating depth and normals */
    PST_SEMI,        /* directions known, intensities not */
    PST_UNCALIBRATED /* lights unknown, near or distant, of one strength or on one albedo */
} pst_method;

/* The name people type ("ls", "robust", "near", "semi", "uncalibrated", "auto"); -1 if unknown. */
int pst_method_from_name(const char *name);
const char *pst_method_name(pst_method m);

typedef struct pst_surface {
    img normal;            /* 3, unit, z > 0, zero outside the mask */
    img albedo;            /* capture's channels; relative unless intensities are known */
    img depth;             /* 1, camera distance along -z; empty unless the method finds it */
    img residual;          /* 1, root mean square over the images used, relative to the fit */
    pst_method method;     /* the one used */
    pst_light *light;      /* semi, uncalibrated: what was found (count entries); else NULL */
    bool strengths_unsure; /* semi: others than what was found explain the pictures, too: the object is too flat, or
                            * there are 3 of them, which any do and equal ones were taken for */
    bool distance_unsure;  /* near, where the capture does not know how far the object is: nor do the pictures tell */
    bool lights_unsure;    /* uncalibrated: the pictures or the outline tell badly where the lights are */
    bool lights_near;      /* uncalibrated: light has positions, too, in the unit of the mean distance (1 if unknown) */
} pst_surface;

void pst_surface_free(pst_surface *s);

/* Depth (integrate.h) from the normals, unless the method has found it; integrate: even then, held near what it found.
 * shown may be NULL. */
status pst_surface_integrate(const pst_capture *c, bool integrate, bool preserve_edges, const watch *shown,
                             pst_surface *s);

#endif
