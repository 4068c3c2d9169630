/* SPDX-License-Identifier: MIT */
/* Captures of this project's own objects by ray tracing, with true normals and depth, to hold the solvers of
 * photometric stereo against: cast shadows always, light between surfaces if asked for.
 *
 *     rendered how = {.size = 64, .lights = 50, .roughness = 0.3f, .exposure = 1};
 *     merlin_capture c;
 *     status s = rendered_capture(&how, &object, &c);
 *     pst_capture_free(&c);
 *
 * Distant lights shine with radiance 1 a steradian; near lights are LEDs about the camera, or bare bulbs on the frontal
 * hemisphere, and the camera's distance is the true one then. A pixel belongs to the mask if all of it shows the
 * object, not at grazing angles. */
#ifndef MERLIN_LAB_EVAL_STEREO_RENDERED_CAPTURE_H
#define MERLIN_LAB_EVAL_STEREO_RENDERED_CAPTURE_H

#include "lab/scene/scene.h"
#include "stereo/capture/capture.h"

typedef struct rendered {
    int size, lights, strata,
        paths;             /* strata² points a pixel, at most 16; paths: of indirect light a pixel, 0 for none */
    float fov;             /* degrees; 0: orthographic */
    float roughness;       /* 0: the material's own */
    float paleness;        /* factor on the material's albedo; 0: 1 */
    float phong, exponent; /* a lobe phong · (n·h)^exponent instead of the microfacets', if above 0 */
    float exposure;
    bool matte;      /* Lambert's law alone */
    bool unshadowed; /* without cast shadows, but for the surface's own back */
    bool grey, leds, bulbs, eight_bit;
    img *albedo; /* where the true albedo is put, 3 channels, to be freed; NULL: nowhere */
} rendered;

/* Equal scenes give equal pictures, whatever the number of threads. On failure *out needs no freeing. */
status rendered_capture(const rendered *how, const scene_object *object, merlin_capture *out);

#endif
