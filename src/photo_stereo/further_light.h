/* SPDX-License-Identifier: MIT */
/* The light that a further photograph should be taken under. */
#ifndef MERLIN_PHOTO_STEREO_FURTHER_LIGHT_H
#define MERLIN_PHOTO_STEREO_FURTHER_LIGHT_H

#include "base/vec.h"

/* Returns the direction, a unit vector up to 60 degrees from the line to the camera, +z, that tells most of a matte
 * surface beside these lights: that with the largest lᵀ (Σ lₖ lₖᵀ)⁻¹ l, which makes the determinant of the sum, and so
 * the precision of the normals, largest (D-optimal design). light: count directions, shorter than 1 where they are
 * unsure. */
vec3 further_light(const vec3 *light, int count);

#endif
