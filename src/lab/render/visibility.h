/* SPDX-License-Identifier: MIT */
/* Finds the points of the object that each pixel sees, by strata × strata camera rays a pixel.
 *
 *     visibility *v;
 *     status s = visibility_new(&scene, &eye, strata, key, &v);
 *     pixel_hits seen;
 *     for (y ...) for (x ...) visibility_pixel(v, x, y, &seen);
 *     visibility_free(v);
 *
 * Inside one surface, and outside the object, a pixel and its neighbours agree: there only one ray per row and column
 * of the strata is traced. The others are traced where the first ones, or those of the eight neighbours, indicate an
 * edge. Rays depend on key and pixel alone. */
#ifndef MERLIN_LAB_RENDER_VISIBILITY_H
#define MERLIN_LAB_RENDER_VISIBILITY_H

#include "lab/render/trace.h"
#include "optics/camera.h"

enum { VISIBILITY_MAX_STRATA = 8, VISIBILITY_MAX_POINTS = VISIBILITY_MAX_STRATA * VISIBILITY_MAX_STRATA };

typedef struct visibility visibility;

/* The points of a pixel that are shaded, and its coverage by the object. */
typedef struct pixel_hits {
    int count;
    float coverage;
    vec3 direction[VISIBILITY_MAX_POINTS];
    trace_hit hit[VISIBILITY_MAX_POINTS];
} pixel_hits;

/* Prepares a picture. strata: 1 or even, at most VISIBILITY_MAX_STRATA. The scene must outlive the result. */
status visibility_new(trace_scene *scene, const camera *eye, int strata, uint64_t key, visibility **out);
void visibility_free(visibility *v);

/* Finds a pixel's points; pixels must be requested row by row from the top. */
void visibility_pixel(visibility *v, int x, int y, pixel_hits *out);

#endif
