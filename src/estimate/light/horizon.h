/* SPDX-License-Identifier: MIT */
/* How much of its surroundings every point of a visible surface sees past the surface itself.
 *
 *     horizon h;
 *     status s = horizon_new(&occluder, &h);                   once a surface
 *     horizon_view at;
 *     horizon_at(&h, 0.3f, 0.6f, &at);                       for a place in the frame
 *     float share = horizon_sees(&at, direction, 0.05f);     of a patch of sky of 0.05 steradians about it
 *     horizon_free(&h);
 *
 * All directions from a point that lie in one half plane with its line of sight follow one line through the picture
 * (N. Max, Horizon mapping, The Visual Computer 4, 1988, for heights over a plane): the surface there hides those
 * further from the line of sight than its steepest point. Kept is the cosine of that angle for some half planes; in
 * between it is interpolated. What is seen is taken to be as thick as in shadow.h; through which parts of the
 * directions beyond the horizon light comes from behind it is kept as bits. */
#ifndef MERLIN_ESTIMATE_LIGHT_HORIZON_H
#define MERLIN_ESTIMATE_LIGHT_HORIZON_H

#include <stdint.h>

#include "estimate/light/shadow.h"

enum { HORIZON_AZIMUTHS = 24 };

typedef struct horizon {
    img cosine;       /* HORIZON_AZIMUTHS channels, cosines of the angle to the line of sight; -1: nothing hides */
    uint32_t *closed; /* as many: bit i: hidden where the cosine is (i + 1/2) / 16 - 1; all above the horizon are set */
    camera_lens lens;
} horizon;

/* Of one place, between four of the horizon's. */
typedef struct horizon_view {
    vec3 view, right, up; /* unit: to the camera, and across */
    float cosine[HORIZON_AZIMUTHS];
    const uint32_t *closed[4];
    float weight[4];
} horizon_view;

/* occluder is not needed afterwards. */
status horizon_new(const shadow_occluder *occluder, horizon *out);
void horizon_free(horizon *h);

/* x, y: shares of the frame's width and height. */
void horizon_at(const horizon *h, float x, float y, horizon_view *out);

/* 0: hidden, 1: seen; direction unit. Soft by the patch's own size, and by how surely an estimated depth tells. */
float horizon_sees(const horizon_view *at, vec3 direction, float solid_angle);

#endif
