/* SPDX-License-Identifier: MIT */
/* The lobe of an LED: it shines less beside its axis, by a power of the cosine (Lichy et al. 2022).
 *
 *     real power = led_share(axis, lobe, l) * power_on_the_axis / (distance * distance);
 *
 * One definition for everybody: what the renderer lights is what the solvers divide by. */
#ifndef MERLIN_OPTICS_LED_H
#define MERLIN_OPTICS_LED_H

#include "base/number.h"
#include "base/vec.h"

/* Returns what an LED sends along -l as a share of what it sends along its axis: max(0, -l·axis)^lobe; axis and l (from
 * the lit point to the LED) unit, lobe the exponent. 1 for exponent 0 and for an axis of 0, 0, 0. */
static inline real led_share(vec3 axis, real lobe, vec3 l)
{
    if (!(lobe > 0) || !(vec3_dot(axis, axis) > 0)) return 1;
    return pow(max_of(-vec3_dot(l, axis), 0), lobe);
}

/* Returns the unit direction from a point to an LED (or to a point light: lobe 0), and what arrives there of power 1:
 * led_share over the squared distance. */
static inline vec3 led_light_at(vec3 position, vec3 axis, real lobe, vec3 at, real *arriving)
{
    const vec3 to = vec3_sub(position, at);
    const real squared = max_of(vec3_dot(to, to), (real)1e-12);
    const vec3 toward = vec3_scale(to, 1 / sqrt(squared));
    *arriving = 1 / squared * led_share(axis, lobe, toward);
    return toward;
}

#endif
