/* One sample rendered into memory.
 *
 *     sample s;
 *     status st = render_image(&scene, &settings, seed, index, environment, &s);
 *     sample_free(&s);
 *
 * Every pixel sends settings.strata² camera rays. All of them count for coverage; where they agree (inside one surface)
 * only one per row and column of the stratification is shaded, since the material is smooth there. Direct light is
 * shaded at the very points whose maps are averaged. Indirect and environment light follow `paths` paths a pixel,
 * spread over those points. Each layer draws from its own random stream, so asking for one more layer changes no other.
 */
#ifndef MERLIN_RENDER_RENDER_H
#define MERLIN_RENDER_RENDER_H

#include "render/environment.h"
#include "render/sample.h"
#include "render/trace.h"

enum { RENDER_MAX_STRATA = 8 };

typedef struct image_settings {
    int size;     /* pixels, square */
    float fov;    /* horizontal, degrees */
    int strata;   /* 1 or even, at most RENDER_MAX_STRATA */
    int paths;    /* per pixel, for each of indirect light, targets and environment */
    int targets;  /* images under lights of the frontal hemisphere, at most SAMPLE_MAX_TARGETS */
    bool bounces; /* keep bounce 2 and bounce 3 apart as well */
} image_settings;

/* Renders the scene's object; environment may be NULL (no env layer). On failure out is empty. */
status render_image(trace_scene *scene, const image_settings *settings, uint64_t seed, uint64_t index,
                    const environment *env, sample *out);

#endif
