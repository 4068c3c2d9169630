/* SPDX-License-Identifier: MIT */
/* Converts public lamps (merlin/lights.h) to those of optics. */
#ifndef MERLIN_ESTIMATE_RELIGHT_LAMP_OF_H
#define MERLIN_ESTIMATE_RELIGHT_LAMP_OF_H

#include "merlin/lights.h"
#include "optics/light.h"

/* Converts a lamp; a direction that is unit within rounding errors is unchanged. */
static inline lamp lamp_of(const merlin_lamp *l)
{
    vec3 at = vec3_of(l->at);
    if (l->distant && fabs(vec3_dot(at, at) - 1) > (real)1e-5) at = vec3_normalize(at);
    return (lamp){at, l->distant != 0, vec3_of(l->power)};
}

static inline merlin_lamp lamp_public(lamp l)
{
    merlin_lamp out = {.distant = l.distant};
    vec3_put(l.at, out.at);
    vec3_put(l.tint, out.power);
    return out;
}

#endif
