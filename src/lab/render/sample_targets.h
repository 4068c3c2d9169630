/* SPDX-License-Identifier: MIT */
/* Random lights of a sample's targets: points in front of the object, and LEDs about the camera.
 *
 *     rng r = rng_at(seed, index, STREAM_LED_PLACES);
 *     sample_target under = {0};
 *     sample_target_draw_led(&r, &under);
 *     point_light light = sample_target_light(&under);
 */
#ifndef MERLIN_LAB_RENDER_SAMPLE_TARGETS_H
#define MERLIN_LAB_RENDER_SAMPLE_TARGETS_H

#include "base/rng.h"
#include "lab/render/paths.h"
#include "lab/render/sample.h"

/* Places a point on the frontal hemisphere (optics/light.h). */
void sample_target_draw(rng *r, sample_target *out);

/* Places an LED as rigs of near-field photometric stereo have them, in units of the camera's distance from the object's
 * middle: uniform over a disc of radius 0.75 about the camera, and up to 0.15 before or behind it; its axis uniform
 * over the directions within 30 degrees of (0, 0, -1), the exponent of its lobe over [0, 2). */
void sample_target_draw_led(rng *r, sample_target *out);

/* Returns the light source, of LIGHT_POWER, which an LED has on its axis. */
point_light sample_target_light(const sample_target *of);

#endif
