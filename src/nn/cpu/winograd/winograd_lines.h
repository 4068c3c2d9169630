/* SPDX-License-Identifier: MIT */
/* The linear maps of F(4, 3): a line of values to six points, or six points back, for a register of channels at once.
 */
#ifndef MERLIN_NN_CPU_WINOGRAD_WINOGRAD_LINES_H
#define MERLIN_NN_CPU_WINOGRAD_WINOGRAD_LINES_H

#include <stdint.h>
#include <string.h>

#include "base/inline.h"

/* Floats of a register, and rows of results, two registers each, that fit the register file together with their
 * operands. */
#ifdef __AVX512F__
enum { WIDE = 16, WINOGRAD_ROWS = 12 };
#else
enum { WIDE = 8, WINOGRAD_ROWS = 6 };
#endif

/* A vector register; passed by address, because how it is passed by value depends on the processor. */
typedef float wide __attribute__((vector_size(WIDE * sizeof(float))));
typedef int32_t wide_bits __attribute__((vector_size(WIDE * sizeof(int32_t))));

ALWAYS_INLINE void wide_load(wide *v, const float *from)
{
    memcpy(v, from, sizeof *v);
}

ALWAYS_INLINE void wide_store(const wide *v, float *to)
{
    memcpy(to, v, sizeof *v);
}

typedef uint16_t wide_words __attribute__((vector_size(WIDE * sizeof(uint16_t))));
typedef uint32_t wide_codes __attribute__((vector_size(WIDE * sizeof(uint32_t))));

/* Converts bfloat16 numbers to floats. */
ALWAYS_INLINE void wide_widen(wide *v, const uint16_t *from)
{
    wide_words words;
    memcpy(&words, from, sizeof words);
    *v = (wide)(__builtin_convertvector(words, wide_codes) << 16);
}

/* Converts to bfloat16, rounding to nearest even as float_to_bf16 does. */
ALWAYS_INLINE void wide_narrow(const wide *v, uint16_t *to)
{
    wide_codes bits = (wide_codes)*v, rounded = bits + 0x7fff + (bits >> 16 & 1);
    wide_codes nan = (wide_codes)((bits & 0x7fffffff) > 0x7f800000);
    bits = (rounded & ~nan) | ((bits | 0x400000) & nan);
    wide_words words = __builtin_convertvector(bits >> 16, wide_words);
    memcpy(to, &words, sizeof words);
}

typedef void line_map(const wide *from, wide *to);

/* Computes Bᵀ d, of six values. */
ALWAYS_INLINE void input_line(const wide *d, wide *v)
{
    wide even = d[4] - 4 * d[2], odd = d[3] - 4 * d[1], outer = d[4] - d[2], twice = 2 * (d[3] - d[1]);
    v[0] = 4 * d[0] - 5 * d[2] + d[4];
    v[1] = even + odd;
    v[2] = even - odd;
    v[3] = outer + twice;
    v[4] = outer - twice;
    v[5] = 4 * d[1] - 5 * d[3] + d[5];
}

/* Computes Aᵀ m, four values. */
ALWAYS_INLINE void output_line(const wide *m, wide *y)
{
    wide sum = m[1] + m[2], difference = m[1] - m[2], far_sum = m[3] + m[4], far_difference = m[3] - m[4];
    y[0] = m[0] + sum + far_sum;
    y[1] = difference + 2 * far_difference;
    y[2] = sum + 4 * far_sum;
    y[3] = difference + 8 * far_difference + m[5];
}

/* Computes A y, of four values. */
ALWAYS_INLINE void output_line_back(const wide *y, wide *m)
{
    wide even = y[0] + y[2], odd = y[1] + y[3], far_even = y[0] + 4 * y[2], far_odd = 2 * y[1] + 8 * y[3];
    m[0] = y[0];
    m[1] = even + odd;
    m[2] = even - odd;
    m[3] = far_even + far_odd;
    m[4] = far_even - far_odd;
    m[5] = y[3];
}

/* Computes G g, of three values. */
ALWAYS_INLINE void kernel_line(const wide *g, wide *u)
{
    wide even = (g[0] + g[2]) * (-1.0f / 6), odd = g[1] * (-1.0f / 6),
         far_even = g[0] * (1.0f / 24) + g[2] * (1.0f / 6), far_odd = g[1] * (1.0f / 12);
    u[0] = g[0] * 0.25f;
    u[1] = even + odd;
    u[2] = even - odd;
    u[3] = far_even + far_odd;
    u[4] = far_even - far_odd;
    u[5] = g[2];
}

/* Computes Gᵀ u, three values. */
ALWAYS_INLINE void kernel_line_back(const wide *u, wide *g)
{
    wide sum = (u[1] + u[2]) * (-1.0f / 6), difference = (u[2] - u[1]) * (1.0f / 6), far_sum = u[3] + u[4],
         far_difference = u[3] - u[4];
    g[0] = u[0] * 0.25f + sum + far_sum * (1.0f / 24);
    g[1] = difference + far_difference * (1.0f / 12);
    g[2] = sum + far_sum * (1.0f / 6) + u[5];
}

#endif
