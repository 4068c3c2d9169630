/* SPDX-License-Identifier: MIT */
/* Judges whether the light of a photograph stood at the lens, as its maps take for granted.
 *
 *     light_cues cues;
 *     status s = light_cues_find(&maps, &photo, &frame, &cues);
 *     float doubt = light_cues_elsewhere(&cues);
 *
 * Under a flash at the lens all sides of an object grow darker toward its outline, since there the surface turns away
 * from lens and light alike. Under light from elsewhere one side stays bright, another is black; in a room's light
 * hardly any side grows darker, and what is estimated of it comes out flat or hollow. How well the maps explain the
 * photograph tells little: whatever is lit wrongly becomes albedo or relief.
 *
 * All cues are local slopes of log luminance or of the maps, as medians, so that what is painted on an object, which
 * has sharp edges, and its colours' brightness do not count. */
#ifndef MERLIN_ESTIMATE_PHOTO_LIGHT_CUES_H
#define MERLIN_ESTIMATE_PHOTO_LIGHT_CUES_H

#include <stdbool.h>

#include "estimate/surface/surface.h"

/* Lengths are in units of the radius of a disc of the object's area. */
typedef struct light_cues {
    bool known;    /* enough of the outline lies within the photograph, and enough of the object is not burnt out */
    float fall;    /* change of log luminance outward, near the outline: some -3 under a flash */
    float tilt;    /* of log luminance over all of the object: what is left of it when its slopes are summed */
    float rest;    /* the same of what the maps' shading under a flash leaves unexplained */
    float black;   /* share of the object that is nearly black */
    float outward; /* how far the normals along the outline point away from the object: 0.6 under a flash */
    float inward;  /* share of them that point into it */
    float rise;    /* how much farther away than its middle the outline is */
} light_cues;

/* Frame of the photograph among the maps' pixels: those from left, top to right, bottom lie in it; an object's
 * end at its edge is no outline. A value of `white` is burnt out. */
typedef struct light_frame {
    float left, top, right, bottom, white;
} light_frame;

/* photo: 3 channels, of the maps' size. */
status light_cues_find(const surface *maps, const img *photo, const light_frame *frame, light_cues *out);
/* Returns how likely the light was not at the lens, in [0, 1]; 0 where the cues are not known. */
float light_cues_elsewhere(const light_cues *cues);

#endif
