/* SPDX-License-Identifier: MIT */
/* The part of its environment that every point of a visible surface sees past the surface itself.
 *
 *     horizon h;
 *     status s = horizon_new(&occluder, &h);                 once per surface
 *     horizon_view at;
 *     horizon_at(&h, 0.3f, 0.6f, &at);                       for a place in the frame
 *     float share = horizon_sees(&at, direction, 0.05f);     visible share of a patch of sky of 0.05 steradians
 *     horizon_free(&h);
 *
 * All directions from a point that lie in one half plane with its line of sight project to one line in the picture (N.
 * Max, Horizon mapping, The Visual Computer 4, 1988, for heights over a plane): the surface there hides those further
 * from the line of sight than its steepest point. The cosine of that angle is stored for some half planes and
 * interpolated between them. The surface is assumed to be as thick as in shadow.h; bits store through which directions
 * beyond the horizon light passes behind it. */
#ifndef MERLIN_ESTIMATE_LIGHT_HORIZON_H
#define MERLIN_ESTIMATE_LIGHT_HORIZON_H

#include <stdint.h>

#include "estimate/light/shadow.h"

enum { HORIZON_AZIMUTHS = 24 };

typedef struct horizon {
    img cosine;       /* HORIZON_AZIMUTHS channels of cosines of the angle to the line of sight; -1: nothing hides */
    uint32_t *closed; /* words of as many azimuths; bit i: hidden where the cosine is (i + 1/2) / 16 - 1; all bits above
                       * the horizon are set */
    camera_lens lens;
} horizon;

/* The horizon of one place, interpolated between four points. */
typedef struct horizon_view {
    vec3 view, right, up; /* unit vectors: to the camera, and across */
    float cosine[HORIZON_AZIMUTHS];
    const uint32_t *closed[4];
    float weight[4];
} horizon_view;

/* Makes the horizon; the occluder is not needed afterwards. */
status horizon_new(const shadow_occluder *occluder, horizon *out);
void horizon_free(horizon *h);

/* Interpolates the horizon; x, y: shares of the frame's width and height. */
void horizon_at(const horizon *h, float x, float y, horizon_view *out);

/* Returns the visibility of a patch of sky in a unit direction, from 0 (hidden) to 1 (visible). The transition is as
 * wide as the patch itself and the uncertainty of an estimated depth. */
float horizon_sees(const horizon_view *at, vec3 direction, float solid_angle);

#endif
