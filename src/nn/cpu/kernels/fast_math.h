/* SPDX-License-Identifier: MIT */
/* exp, sigmoid and tanh without branches or tables, so that loops over them vectorize. NaN in, NaN out. */
#ifndef MERLIN_NN_CPU_KERNELS_FAST_MATH_H
#define MERLIN_NN_CPU_KERNELS_FAST_MATH_H

#include "base/half.h"

/* Returns e^x to 2e-7 relative for x in [-87, 88]; clamped beyond. x = n ln 2 + r with |r| <= ln 2 / 2, Taylor in r. */
static inline float fast_exp(float x)
{
    x = x > 88.0f ? 88.0f : x;
    x = x < -87.0f ? -87.0f : x;
    /* adding 1.5 * 2^23 rounds to an integer, which is then in the low bits */
    const float magic = 0x1.8p23f;
    float shifted = x * 1.44269504f + magic;
    float n = shifted - magic;
    float r = x - n * 0x1.62e4p-1f;
    r = r - n * 0x1.7f7d1cp-20f;
    float p = 1.0f / 5040;
    p = p * r + 1.0f / 720;
    p = p * r + 1.0f / 120;
    p = p * r + 1.0f / 24;
    p = p * r + 1.0f / 6;
    p = p * r + 0.5f;
    p = p * r + 1.0f;
    p = p * r + 1.0f;
    return p * bits_float((float_bits(shifted) + 127u) << 23);
}

/* Returns the sigmoid to 3e-7 relative for x > -87. */
static inline float fast_sigmoid(float x)
{
    return 1 / (1 + fast_exp(-x));
}

/* Returns tanh to 3e-7 relative: an odd minimax polynomial (Moshier, Cephes) below 0.625, where 1 - 2/(e^2x + 1)
 * cancels. */
static inline float fast_tanh(float x)
{
    float a = x < 0 ? -x : x, z = x * x;
    float large = 1 - 2 / (fast_exp(2 * a) + 1);
    large = x < 0 ? -large : large;
    float p = -5.70498872745e-3f;
    p = p * z + 2.06390887954e-2f;
    p = p * z - 5.37397155531e-2f;
    p = p * z + 1.33314422036e-1f;
    p = p * z - 3.33332819422e-1f;
    float small = p * z * x + x;
    return a < 0.625f ? small : large;
}

#endif
