/* SPDX-License-Identifier: MIT */
/* Random palettes of matching colours, from which an object's paints are mixed. */
#ifndef MERLIN_LAB_SCENE_MATERIAL_PALETTE_H
#define MERLIN_LAB_SCENE_MATERIAL_PALETTE_H

#include "base/rng.h"
#include "base/vec.h"

enum { PALETTE = 6 };

/* Fills colour[PALETTE] with linear albedos in [0.01, 0.95] of one random theme: natural, painted, pale, dark, of one
 * hue, or arbitrary. */
void palette_random(rng *r, vec3 colour[PALETTE]);

/* Returns the linear colour of a hue (in turns), saturation and sRGB-encoded value. */
vec3 colour_hsv(float hue, float saturation, float value);

#endif
