/* SPDX-License-Identifier: MIT */
/* One photograph as a capture for photometric stereo: its object relit under many known near lights.
 *
 *     relit r;
 *     status s = relit_new(model, &maps, 256, NULL, &r);
 *     ... solve r.capture, and compare with r.maps.normal ...
 *     relit_free(&r);
 */
#ifndef MERLIN_PHOTO_STEREO_RELIT_H
#define MERLIN_PHOTO_STEREO_RELIT_H

#include "estimate/surface/surface.h"
#include "merlin/merlin.h"
#include "stereo/capture/capture.h"

enum { RELIT_LIGHTS = 50 };

/* The usual way of relighting. */
#define RELIT_BY MERLIN_BY_BRDF_UNSHADOWED

typedef struct relit {
    merlin_capture capture; /* RELIT_LIGHTS pictures of the maps' crop; its camera.distance is the maps' mean depth */
    surface maps;           /* maps from which they were rendered, of the same size */
} relit;

/* Renders the maps' crop in side × side pixels under lights of the frontal hemisphere, drawn with a fixed seed, in
 * this way. stop (may be NULL) is called between pictures. */
status relit_new(merlin_model *model, const merlin_maps *maps, int side, merlin_relighting how, int (*stop)(void),
                 relit *out);
void relit_free(relit *r);

#endif
