/* SPDX-License-Identifier: MIT */
/* Colours that go together: what an object's paints are mixed from. */
#ifndef MERLIN_LAB_SCENE_MATERIAL_PALETTE_H
#define MERLIN_LAB_SCENE_MATERIAL_PALETTE_H

#include "base/rng.h"
#include "base/vec.h"

enum { PALETTE = 6 };

/* Fills colour[PALETTE] with linear albedos in [0.01, 0.95] of one random theme: natural, painted, pale, dark, of one
 * hue, or anything. */
void palette_random(rng *r, vec3 colour[PALETTE]);

/* Linear colour of hue (turns), saturation and sRGB-encoded value. */
vec3 colour_hsv(float hue, float saturation, float value);

#endif
