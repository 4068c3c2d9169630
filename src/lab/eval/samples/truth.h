/* SPDX-License-Identifier: MIT */
/* A sample's truth, and pictures rendered from maps to be held against each other.
 *
 *     surface truth;
 *     status s = eval_truth(&sample, &sample.mask, &truth);
 *     img lit;
 *     if (s == OK) s = eval_render(&truth, &light, 1, &lit);
 *     surface_free(&truth);
 */
#ifndef MERLIN_LAB_EVAL_SAMPLES_TRUTH_H
#define MERLIN_LAB_EVAL_SAMPLES_TRUTH_H

#include "estimate/surface/surface.h"
#include "lab/render/sample.h"

/* Copies the sample's maps; pictures of them are multiplied by the mask. */
status eval_truth(const sample *s, const img *mask, surface *out);

/* Makes the mask that the network is trained with: 1 where the coverage is above EVAL_MASK_LEVEL, else 0. */
status eval_binary_mask(const img *coverage, img *out);

/* Renders the surface under a light without shadows and bounces, times the exposure, then clipped to [0, 1]; what it
 * reflects of the surroundings is diffuse. out is made here. */
status eval_render(const surface *maps, const illumination *light, float exposure, img *out);

/* Adds a and b, which may be NULL, clipped to [0, 1] and zero outside the mask. */
status eval_picture(const img *a, const img *b, const img *mask, img *out);

/* Draws the sample's target light number i from its seed and index: the same in every evaluation. */
vec3 eval_light(const sample *s, int i);

#endif
