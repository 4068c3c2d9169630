/* SPDX-License-Identifier: MIT */
/* Random lamps: anywhere in front of an object and beside it, near or far, points or small discs.
 *
 *     rng r = rng_at(seed, index, STREAM_LAMPS);
 *     sample_lamp lamp = {0};
 *     sample_lamp_draw(&r, object, &lamp);
 *     point_light light = sample_lamp_light(&lamp);
 */
#ifndef MERLIN_LAB_RENDER_SAMPLE_LAMPS_H
#define MERLIN_LAB_RENDER_SAMPLE_LAMPS_H

#include "base/rng.h"
#include "lab/render/paths.h"
#include "lab/render/sample.h"
#include "lab/scene/scene.h"

/* Places a lamp, relative to the object's middle (0, 0, -1): up to 110 degrees from the line to the camera; from 0.4 to
 * 3 times as far as the camera and outside the object, or, one in four, infinitely far; one in two a disc of up to 11
 * degrees' radius. */
void sample_lamp_draw(rng *r, const scene_object *object, sample_lamp *out);

/* Places a point as far from the object's middle as the camera, at this angle (degrees) from the line to it. */
void sample_lamp_draw_at(rng *r, float angle, sample_lamp *out);

/* Returns the lamp as a light source, as bright at the object's middle as the flash is. */
point_light sample_lamp_light(const sample_lamp *of);

#endif
