/* SPDX-License-Identifier: MIT */
/* Photometric stereo with unknown lights and a surface that is expected: a network's.
 *
 *     merlin_maps_from_capture estimates maps of several pictures, then
 *     status s = prior_stereo_refine(&(prior_stereo){capture, lights, near_network, stop}, &maps); */
#ifndef MERLIN_PHOTO_STEREO_PRIOR_STEREO_H
#define MERLIN_PHOTO_STEREO_PRIOR_STEREO_H

#include "base/status.h"
#include "base/vec.h"
#include "merlin/surface.h"

/* The pictures' lights as they are expected, in the maps' space: pst_expected's. */
typedef struct prior_lights {
    const vec3 *light, *compared;
    const float *near;
} prior_lights;

typedef struct prior_stereo {
    const merlin_capture *capture;
    prior_lights lights;
    const merlin_near_network *near; /* of near lights; NULL: none */
    int (*stop)(void);               /* may be NULL */
} prior_stereo;

/* Replaces the maps' normals, and the depth that agrees with them, by those of photometric stereo, if that explains the
 * pictures by a similar surface; else leaves the maps as they are. */
status prior_stereo_refine(const prior_stereo *p, merlin_maps *maps);

#endif
