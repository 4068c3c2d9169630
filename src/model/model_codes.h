/* SPDX-License-Identifier: MIT */
/* Encodings of a network's inputs and outputs as numbers, which need no graph. */
#ifndef MERLIN_MODEL_MODEL_CODES_H
#define MERLIN_MODEL_MODEL_CODES_H

#include <stdbool.h>
#include <stddef.h>

#include "model/model_config.h"
#include "optics/camera.h"

/* Largest radiance that the network distinguishes: photographs whose white is higher are scaled down first. */
#define MODEL_BRIGHTEST 4.0f

/* Encodes the input "image": the square root of radiance clamped to [0, MODEL_BRIGHTEST], which distributes the
 * network's precision as the eye (and sRGB) does. Radiance is in the unit of the lights' power; where a photograph is
 * saturated (radiance 1 in the published data, up to 2.5 in training) it is constant. n values; in place is allowed. */
void model_encode_image(const float *linear, float *encoded, size_t n);

/* Encodes an environment's nine coefficients (optics/sh.h): scaled by the clamped cosine's factor of their band, so
 * that the mean square of a difference is that of a white surface's radiance over all normals; model_decode_sh is the
 * inverse. In place is allowed. */
void model_encode_sh(const float sh[9][3], float code[MODEL_SH]);
void model_decode_sh(const float code[MODEL_SH], float sh[9][3]);

/* Encode a light's strength as ln(1 + strength), and back; not below 0. */
float model_encode_strength(float strength);
float model_decode_strength(float code);

/* Fills in the input "sight", what is known of how a photograph was taken: for a picture of size × size, MODEL_SIGHT
 * values a pixel. lens NULL: unknown. flash: the photograph is lit by a flash alone, as far as is known. */
enum { MODEL_SIGHT = 4 };
void model_sight(const camera *lens, bool flash, int size, float *out);

/* Fills in the input "share" of an object's pictures, one value a pixel: a picture's light there over the root mean
 * square of all pictures' light, less 1, which does without the albedo of a matte surface; each picture's light is
 * measured by its mean, as exposures differ. 0 where no picture has light, and in a single picture. images: the inputs
 * "image" of the pictures one behind another, of so many pixels each. */
void model_encode_shares(const float *images, int pictures, size_t pixels, float *shares);

/* Returns the length of the lighting code: 3 or 30. */
int model_light_size(const model_config *config);

#endif
