/* sRGB by table, exact: an 8-bit or 16-bit code to linear light and back. srgb_encode and srgb_decode, the formula
 * itself, are in write.h. */
#ifndef MERLIN_IMAGE_COLOR_H
#define MERLIN_IMAGE_COLOR_H

#include <stdint.h>

/* 256 and 65536 linear values, by code. */
const float *srgb_decode_table8(void);
const float *srgb_decode_table16(void);

/* The code nearest to srgb_encode(linear) × 255; NaN becomes 0. */
uint8_t srgb_code8(float linear);

#endif
