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

#endif
