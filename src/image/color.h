/* SPDX-License-Identifier: MIT */
/* Luminance of linear sRGB, and the sRGB transfer curve, exactly: by formula, and by table for 8-bit and 16-bit codes.
 */
#ifndef MERLIN_IMAGE_COLOR_H
#define MERLIN_IMAGE_COLOR_H

#include <stddef.h>
#include <stdint.h>

/* Returns the luminance by ITU-R BT.709. */
static inline float color_luminance(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

float srgb_encode(float linear);
float srgb_decode(float encoded);

/* Tables of 256 and 65536 linear values, by code. */
const float *srgb_decode_table8(void);
const float *srgb_decode_table16(void);

/* Return the code nearest to srgb_encode(linear) × 255, for `count` values or for one; NaN becomes 0. */
void srgb_codes8(const float *linear, size_t count, uint8_t *codes);
uint8_t srgb_code8(float linear);

#endif
