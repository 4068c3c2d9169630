/* SPDX-License-Identifier: MIT */
/* Low-discrepancy numbers for the paths of a picture: Sobol' points with Owen scrambling (Burley 2020), assigned to
 * pixels in Z-order (Ahmed & Wonka 2020), so that a pixel's paths, and those of every square block of pixels, cover the
 * square of directions evenly. After filtering over a few pixels this leaves far less noise than random numbers.
 *
 *     sequence q = sequence_of(seed);
 *     path_start s = sequence_at(&q, SEQUENCE_DIRECTION, sequence_index(x, y) * paths + i);
 */
#ifndef MERLIN_LAB_RENDER_SEQUENCE_H
#define MERLIN_LAB_RENDER_SEQUENCE_H

#include <stdint.h>

#include "base/rng.h"
#include "base/vec.h"

/* A point in the unit square; each coordinate in [0, 1). */
typedef struct path_start {
    real u1, u2;
} path_start;

/* Purposes for which a path needs pairs of numbers. */
enum { SEQUENCE_DIRECTION, SEQUENCE_CHOICE, SEQUENCE_LIGHT, SEQUENCE_SECOND, SEQUENCE_PAIRS };

typedef struct sequence {
    uint32_t order[SEQUENCE_PAIRS], first[SEQUENCE_PAIRS], second[SEQUENCE_PAIRS]; /* seeds of the scrambling */
} sequence;

/* Returns the sequence of one layer of a sample, seeded from r. */
static inline sequence sequence_of(rng *r)
{
    sequence q;
    for (int k = 0; k < SEQUENCE_PAIRS; k++) {
        q.order[k] = rng_u32(r);
        q.first[k] = rng_u32(r);
        q.second[k] = rng_u32(r);
    }
    return q;
}

static inline uint32_t sequence_spread(uint32_t x)
{
    x = (x | (x << 8)) & 0x00ff00ffu;
    x = (x | (x << 4)) & 0x0f0f0f0fu;
    x = (x | (x << 2)) & 0x33333333u;
    return (x | (x << 1)) & 0x55555555u;
}

/* Returns the index of a pixel in Z-order; x and y below 65536. */
static inline uint32_t sequence_index(int x, int y)
{
    return sequence_spread((uint32_t)x) | (sequence_spread((uint32_t)y) << 1);
}

static inline uint32_t sequence_reverse(uint32_t x)
{
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    return __builtin_bswap32(x);
}

/* Returns the Owen scrambling of a number whose lowest bit weighs most (Laine & Karras 2011, constants of Burley 2020).
 */
static inline uint32_t sequence_scramble(uint32_t x, uint32_t seed)
{
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    return x ^ (x * 0x8d22f6e6u);
}

/* Returns the second coordinate of Sobol' point i, lowest bit first: Pascal's triangle modulo 2 applied to the bits of
 * i. */
static inline uint32_t sequence_sobol2(uint32_t i)
{
    i ^= (i >> 1) & 0x55555555u;
    i ^= (i >> 2) & 0x33333333u;
    i ^= (i >> 4) & 0x0f0f0f0fu;
    i ^= (i >> 8) & 0x00ff00ffu;
    return i ^ (i >> 16);
}

/* Converts a number with the lowest bit first to [0, 1). */
static inline real sequence_fraction(uint32_t bits)
{
    return (real)(sequence_reverse(bits) >> 8) * (real)0x1p-24;
}

/* Returns pair k of path i. */
static inline path_start sequence_at(const sequence *q, int k, uint32_t i)
{
    /* scrambling the order keeps blocks of 2^n paths together, and combines each pair differently with the others */
    uint32_t place = sequence_reverse(sequence_scramble(sequence_reverse(i), q->order[k]));
    return (path_start){sequence_fraction(sequence_scramble(place, q->first[k])),
                        sequence_fraction(sequence_scramble(sequence_sobol2(place), q->second[k]))};
}

#endif
