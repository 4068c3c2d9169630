/* SPDX-License-Identifier: MIT */
/* Estimates whether the light of a photograph was at the lens, as its maps assume.
 *
 *     light_cues cues;
 *     status s = light_cues_find(&maps, &photo, &frame, &cues);
 *     float doubt = light_cues_elsewhere(&cues);
 *
 * Under a flash at the lens all sides of an object become darker toward its outline, where the surface turns away from
 * lens and light alike. Under light from elsewhere one side stays bright and another is black; in a room's light hardly
 * any side becomes darker, and the estimated shape is flat or concave. How well the maps explain the photograph says
 * little, as wrongly assumed light becomes albedo or relief.
 *
 * All cues are medians of local slopes of log luminance or of the maps, so that paint on an object, which has sharp
 * edges, and the brightness of its colours have no effect. */
#ifndef MERLIN_ESTIMATE_PHOTO_LIGHT_CUES_H
#define MERLIN_ESTIMATE_PHOTO_LIGHT_CUES_H

#include <stdbool.h>

#include "estimate/surface/surface.h"

/* Cues. Lengths are in units of the radius of a disc of the object's area. */
typedef struct light_cues {
    bool known;    /* enough of the outline is in the photograph, and enough of the object is not burnt out */
    float fall;    /* outward slope of log luminance near the outline: about -3 under a flash */
    float tilt;    /* mean slope of log luminance over the object */
    float rest;    /* median slope of log luminance that the maps' shading under a flash does not explain */
    float black;   /* share of the object that is nearly black */
    float outward; /* outward component of the normals along the outline: 0.6 under a flash */
    float inward;  /* share of these normals that point inward */
    float rise;    /* distance of the outline behind the object's middle */
} light_cues;

/* Frame of the photograph in the maps' pixels: those from left, top to right, bottom lie in it; where the frame cuts
 * the object off there is no outline. Values from `white` on are burnt out. */
typedef struct light_frame {
    float left, top, right, bottom, white;
} light_frame;

/* Finds the cues. photo: 3 channels, of the maps' size. */
status light_cues_find(const surface *maps, const img *photo, const light_frame *frame, light_cues *out);
/* Returns the probability that the light was not at the lens, in [0, 1]; 0 if the cues are not known. */
float light_cues_elsewhere(const light_cues *cues);

#endif
