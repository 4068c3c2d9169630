/* SPDX-License-Identifier: MIT */
/* Vector operations of least squares: splitting pictures' codes into channels, and interleaving results. Sixteen pixels
 * are processed together where registers are that wide, else eight; the order in which values are loaded is written out
 * for each, because compilers turn vectors that do not match their registers into scalar code (which took 18 times as
 * long). Vectors are passed by address, as passing by value depends on the processor. */
#ifndef MERLIN_STEREO_METHODS_LS_LANES_H
#define MERLIN_STEREO_METHODS_LS_LANES_H

#ifdef __AVX2__
#include <immintrin.h>
#endif
#include <stdint.h>
#include <string.h>

#ifdef __AVX512BW__
enum { LS_LANES = 16 };
#else
enum { LS_LANES = 8 };
#endif
typedef float ls_lanes __attribute__((vector_size(LS_LANES * sizeof(float))));
typedef int32_t ls_lane_bits __attribute__((vector_size(LS_LANES * sizeof(int32_t))));

/* Codes of LS_LANES pixels; a grey picture has only the first. */
typedef struct ls_lane_colour {
    ls_lanes r, g, b;
} ls_lane_colour;

/* ls_lanes_of_grey and ls_lanes_of_colour load twice LS_LANES pixels, the first half's codes and the second's.
 * ls_lanes_weave interleaves three components, 3 LS_LANES values, one register per store. */

#ifdef __AVX512BW__

typedef uint32_t ls_lane_words __attribute__((vector_size(LS_LANES * sizeof(uint32_t))));
typedef uint16_t ls_lane_codes
    __attribute__((vector_size(2 * LS_LANES * sizeof(uint16_t)))); /* of twice as many pixels */

/* Separates the even and the odd codes of a vector. */
static inline void ls_lanes_widen(const ls_lane_codes *codes, ls_lanes *even, ls_lanes *odd)
{
    *even = __builtin_convertvector((ls_lane_bits)((ls_lane_words)*codes & 0xffff), ls_lanes);
    *odd = __builtin_convertvector((ls_lane_bits)((ls_lane_words)*codes >> 16), ls_lanes);
}

/* Loads codes; before they are widened, those of the two halves alternate. */
static inline void ls_lanes_of_grey(const uint16_t *from, ls_lane_colour *first, ls_lane_colour *second)
{
    ls_lane_codes in;
    memcpy(&in, from, sizeof in);
    ls_lane_codes mixed = __builtin_shufflevector(in, in, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23, 8, 24,
                                                  9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
    ls_lanes_widen(&mixed, &first->r, &second->r);
}

/* Selects every third code of 96: from the first two vectors as far as they go, the rest from the last one. */
static inline void ls_lanes_of_colour(const uint16_t *from, ls_lane_colour *first, ls_lane_colour *second)
{
    ls_lane_codes p, q, s;
    memcpy(&p, from, sizeof p);
    memcpy(&q, from + 2 * LS_LANES, sizeof q);
    memcpy(&s, from + 4 * LS_LANES, sizeof s);
    ls_lane_codes some = __builtin_shufflevector(p, q, 0, 48, 3, 51, 6, 54, 9, 57, 12, 60, 15, 63, 18, 0, 21, 0, 24, 0,
                                                 27, 0, 30, 0, 33, 0, 36, 0, 39, 0, 42, 0, 45, 0);
    ls_lane_codes red = __builtin_shufflevector(some, s, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 34, 14, 37, 16, 40,
                                                18, 43, 20, 46, 22, 49, 24, 52, 26, 55, 28, 58, 30, 61);
    some = __builtin_shufflevector(p, q, 1, 49, 4, 52, 7, 55, 10, 58, 13, 61, 16, 0, 19, 0, 22, 0, 25, 0, 28, 0, 31, 0,
                                   34, 0, 37, 0, 40, 0, 43, 0, 46, 0);
    ls_lane_codes green = __builtin_shufflevector(some, s, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 32, 12, 35, 14, 38, 16, 41,
                                                  18, 44, 20, 47, 22, 50, 24, 53, 26, 56, 28, 59, 30, 62);
    some = __builtin_shufflevector(p, q, 2, 50, 5, 53, 8, 56, 11, 59, 14, 62, 17, 0, 20, 0, 23, 0, 26, 0, 29, 0, 32, 0,
                                   35, 0, 38, 0, 41, 0, 44, 0, 47, 0);
    ls_lane_codes blue = __builtin_shufflevector(some, s, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 33, 12, 36, 14, 39, 16, 42,
                                                 18, 45, 20, 48, 22, 51, 24, 54, 26, 57, 28, 60, 30, 63);
    ls_lanes_widen(&red, &first->r, &second->r);
    ls_lanes_widen(&green, &first->g, &second->g);
    ls_lanes_widen(&blue, &first->b, &second->b);
}

static inline void ls_lanes_weave(const ls_lanes *x, const ls_lanes *y, const ls_lanes *z, float *to)
{
    ls_lanes some = __builtin_shufflevector(*x, *y, 0, 16, 0, 1, 17, 0, 2, 18, 0, 3, 19, 0, 4, 20, 0, 5);
    ls_lanes all = __builtin_shufflevector(some, *z, 0, 1, 16, 3, 4, 17, 6, 7, 18, 9, 10, 19, 12, 13, 20, 15);
    memcpy(to, &all, sizeof all);
    some = __builtin_shufflevector(*x, *y, 21, 0, 6, 22, 0, 7, 23, 0, 8, 24, 0, 9, 25, 0, 10, 26);
    all = __builtin_shufflevector(some, *z, 0, 21, 2, 3, 22, 5, 6, 23, 8, 9, 24, 11, 12, 25, 14, 15);
    memcpy(to + LS_LANES, &all, sizeof all);
    some = __builtin_shufflevector(*x, *y, 0, 11, 27, 0, 12, 28, 0, 13, 29, 0, 14, 30, 0, 15, 31, 0);
    all = __builtin_shufflevector(some, *z, 26, 1, 2, 27, 4, 5, 28, 7, 8, 29, 10, 11, 30, 13, 14, 31);
    memcpy(to + 2 * LS_LANES, &all, sizeof all);
}

#else

typedef uint16_t ls_lane_codes __attribute__((vector_size(LS_LANES * sizeof(uint16_t)))); /* half a register */

static inline void ls_lanes_widen(const ls_lane_codes *codes, ls_lanes *to)
{
#ifdef __AVX2__
    ls_lane_bits wide =
        (ls_lane_bits)_mm256_cvtepu16_epi32((__m128i)*codes); /* gcc 12 would widen the halves and join them */
#else
    ls_lane_bits wide = __builtin_convertvector(*codes, ls_lane_bits);
#endif
    *to = __builtin_convertvector(wide, ls_lanes);
}

/* Splits eight pixels' codes: at every place one of three vectors has each channel, so that two blends find a channel's
 * eight codes and one shuffle sorts them. */
static inline void ls_lanes_of_eight(const uint16_t *from, ls_lane_colour *to)
{
    ls_lane_codes p, q, s;
    memcpy(&p, from, sizeof p);
    memcpy(&q, from + LS_LANES, sizeof q);
    memcpy(&s, from + 2 * LS_LANES, sizeof s);
    ls_lane_codes red = __builtin_shufflevector(p, q, 0, 9, 2, 3, 12, 5, 6, 15);
    red = __builtin_shufflevector(red, s, 0, 1, 10, 3, 4, 13, 6, 7);
    red = __builtin_shufflevector(red, red, 0, 3, 6, 1, 4, 7, 2, 5);
    ls_lanes_widen(&red, &to->r);
    ls_lane_codes green = __builtin_shufflevector(p, q, 0, 1, 10, 3, 4, 13, 6, 7);
    green = __builtin_shufflevector(green, s, 8, 1, 2, 11, 4, 5, 14, 7);
    green = __builtin_shufflevector(green, green, 1, 4, 7, 2, 5, 0, 3, 6);
    ls_lanes_widen(&green, &to->g);
    ls_lane_codes blue = __builtin_shufflevector(p, q, 8, 1, 2, 11, 4, 5, 14, 7);
    blue = __builtin_shufflevector(blue, s, 0, 9, 2, 3, 12, 5, 6, 15);
    blue = __builtin_shufflevector(blue, blue, 2, 5, 0, 3, 6, 1, 4, 7);
    ls_lanes_widen(&blue, &to->b);
}

static inline void ls_lanes_of_grey(const uint16_t *from, ls_lane_colour *first, ls_lane_colour *second)
{
    ls_lane_codes p, q;
    memcpy(&p, from, sizeof p);
    memcpy(&q, from + LS_LANES, sizeof q);
    ls_lanes_widen(&p, &first->r);
    ls_lanes_widen(&q, &second->r);
}

static inline void ls_lanes_of_colour(const uint16_t *from, ls_lane_colour *first, ls_lane_colour *second)
{
    ls_lanes_of_eight(from, first);
    ls_lanes_of_eight(from + 3 * LS_LANES, second);
}

static inline void ls_lanes_weave(const ls_lanes *x, const ls_lanes *y, const ls_lanes *z, float *to)
{
    ls_lanes some = __builtin_shufflevector(*x, *y, 0, 8, 0, 1, 9, 0, 2, 10);
    ls_lanes all = __builtin_shufflevector(some, *z, 0, 1, 8, 3, 4, 9, 6, 7);
    memcpy(to, &all, sizeof all);
    some = __builtin_shufflevector(*x, *y, 0, 3, 11, 0, 4, 12, 0, 5);
    all = __builtin_shufflevector(some, *z, 10, 1, 2, 11, 4, 5, 12, 7);
    memcpy(to + LS_LANES, &all, sizeof all);
    some = __builtin_shufflevector(*x, *y, 13, 0, 6, 14, 0, 7, 15, 0);
    all = __builtin_shufflevector(some, *z, 0, 13, 2, 3, 14, 5, 6, 15);
    memcpy(to + 2 * LS_LANES, &all, sizeof all);
}

#endif

#endif
