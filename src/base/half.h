/* SPDX-License-Identifier: MIT */
/* 16-bit floats: IEEE half (files, samples in memory) and bfloat16 (network activations), rounded to nearest even. */
#ifndef MERLIN_BASE_HALF_H
#define MERLIN_BASE_HALF_H

#include <stdint.h>
#include <string.h>

#define HALF_LARGEST 65504.0f

static inline uint32_t float_bits(float x)
{
    uint32_t u;
    memcpy(&u, &x, sizeof u);
    return u;
}

static inline float bits_float(uint32_t u)
{
    float x;
    memcpy(&x, &u, sizeof x);
    return x;
}

static inline float bf16_to_float(uint16_t h)
{
    return bits_float((uint32_t)h << 16);
}

static inline uint16_t float_to_bf16(float x)
{
    uint32_t u = float_bits(x);
    if ((u & 0x7fffffffu) > 0x7f800000u) return (uint16_t)((u >> 16) | 0x40u);
    return (uint16_t)((u + 0x7fffu + ((u >> 16) & 1u)) >> 16);
}

/* Converts exactly even where the processor flushes denormal floats to zero: no denormal float arises on the way. */
static inline float half_to_float(uint16_t h)
{
    uint32_t sign = (uint32_t)(h & 0x8000u) << 16, rest = h & 0x7fffu;
    if (rest < 0x400u) return bits_float(sign | float_bits((float)(int32_t)rest * 0x1p-24f));
    uint32_t infinite = rest >= 0x7c00u ? 0x38000000u : 0;
    return bits_float(sign | ((rest << 13) + 0x38000000u + infinite));
}

/* Converts with rounding to nearest even; values beyond the range become infinity. */
static inline uint16_t float_to_half(float x)
{
    uint32_t u = float_bits(x), sign = (u >> 16) & 0x8000u;
    u &= 0x7fffffffu;
    if (u > 0x7f800000u) return (uint16_t)(sign | 0x7e00u);
    if (u >= 0x477ff000u) return (uint16_t)(sign | 0x7c00u);
    if (u < 0x38800000u) {
        /* adding 0.5 aligns the half's subnormal unit 2^-24 with the float's last bit, rounding as it goes */
        float aligned = bits_float(u) + 0.5f;
        return (uint16_t)(sign | (float_bits(aligned) - 0x3f000000u));
    }
    u += 0xc8000fffu + ((u >> 13) & 1u);
    return (uint16_t)(sign | (u >> 13));
}

#endif
