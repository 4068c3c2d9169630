/* SPDX-License-Identifier: MIT */
/* Random numbers that depend on (seed, index, stream) alone: a sample or an augmentation is the same whatever thread
 * makes it and in whatever order.
 *
 *     rng r = rng_at(seed, sample_index, STREAM_SHAPE);
 *     float u = rng_uniform(&r);
 *
 * PCG32 (O'Neill 2014), its state and stream filled by SplitMix64 (Steele et al. 2014). */
#ifndef MERLIN_BASE_RNG_H
#define MERLIN_BASE_RNG_H

#include <math.h>
#include <stdint.h>

typedef struct rng {
    uint64_t state, increment;
} rng;

static inline uint64_t rng_mix(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

static inline uint32_t rng_u32(rng *r)
{
    uint64_t old = r->state;
    r->state = old * 6364136223846793005u + r->increment;
    uint32_t xorshifted = (uint32_t)(((old >> 18) ^ old) >> 27);
    uint32_t rotation = (uint32_t)(old >> 59);
    return (xorshifted >> rotation) | (xorshifted << ((32 - rotation) & 31));
}

static inline rng rng_at(uint64_t seed, uint64_t index, uint64_t stream)
{
    uint64_t key = rng_mix(rng_mix(rng_mix(seed) ^ index) ^ stream);
    rng r = {rng_mix(key), rng_mix(key + 1) | 1u};
    rng_u32(&r);
    return r;
}

/* Returns a number uniform in [0, 1). */
static inline float rng_uniform(rng *r)
{
    return (float)(rng_u32(r) >> 8) * 0x1p-24f;
}

/* Returns a number uniform in [low, high). */
static inline float rng_range(rng *r, float low, float high)
{
    return low + (high - low) * rng_uniform(r);
}

/* Returns a whole number uniform in 0 .. count-1. */
static inline int rng_below(rng *r, int count)
{
    return (int)(((uint64_t)rng_u32(r) * (uint64_t)count) >> 32);
}

/* Returns a standard normal number (Box & Muller 1958; the second value is dropped, so that every call advances the
 * generator equally). */
static inline float rng_normal(rng *r)
{
    float u = 1.0f - rng_uniform(r), v = rng_uniform(r);
    return sqrtf(-2.0f * logf(u)) * cosf(6.28318530718f * v);
}

#endif
