/* SPDX-License-Identifier: MIT */
/* Renders one sample into memory.
 *
 *     sample s;
 *     status st = render_image(&scene, &settings, seed, index, environment, &s);
 *     sample_free(&s);
 *
 * A pixel's points are found by settings.strata² camera rays (render/visibility.h): all of them at edges, one per row
 * and column of the strata inside a surface, as the material is smooth there. Direct light is shaded at the very points
 * whose maps are averaged. Indirect light takes `paths` paths a pixel, spread over those points, and environment light,
 * which is less noisy, five for every eight of them. Each layer has its own random stream, so that requesting another
 * layer changes no other. */
#ifndef MERLIN_LAB_RENDER_RENDER_H
#define MERLIN_LAB_RENDER_RENDER_H

#include "lab/render/environment.h"
#include "lab/render/sample.h"
#include "lab/render/trace.h"
#include "lab/render/visibility.h"

typedef struct image_settings {
    int size;  /* pixels, square */
    float fov; /* horizontal, degrees */
    camera_slant slant;
    int strata;  /* 1 or even, at most VISIBILITY_MAX_STRATA */
    int paths;   /* per pixel, for indirect light and each target */
    int targets; /* number of images under lights of the frontal hemisphere */
    int leds;    /* number of further targets, under LEDs about the camera (render/sample_targets.h); with the others at
                  * most SAMPLE_MAX_TARGETS */
    float lamp_angle[SAMPLE_MAX_LAMPS]; /* degrees; see lamp_angles */
    int lamp_angles; /* > 0: number of lamps, points as far away as the camera, at these angles from the line to it */
    int lamps;       /* number of images under lamps of any position and size (render/sample_lamps.h), at most
                      * SAMPLE_MAX_LAMPS */
    bool bounces;    /* store bounce 2 and bounce 3 separately as well */
} image_settings;

/* Renders the scene's object; environment may be NULL (no env layer). On failure out is empty. */
status render_image(trace_scene *scene, const image_settings *settings, uint64_t seed, uint64_t index,
                    const environment *env, sample *out);

#endif
