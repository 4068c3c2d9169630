/* SPDX-License-Identifier: MIT */
/* Solid noise without tables or state: it depends on lattice hashes alone, so that any thread may evaluate it anywhere.
 *
 *     float height = noise_fbm(vec3_scale(p, 3), 4, seed);
 *     noise_fbms(&points, 4, seed, heights);      the same for sixteen points, for little more time
 */
#ifndef MERLIN_LAB_SCENE_SHAPE_NOISE_H
#define MERLIN_LAB_SCENE_SHAPE_NOISE_H

#include <stdint.h>

#include "base/lanes.h"

/* Returns well-mixed bits of a lattice point. */
static inline uint32_t noise_hash(int x, int y, int z, uint32_t seed)
{
    uint32_t h = ((uint32_t)x * 0x8da6b343u) ^ ((uint32_t)y * 0xd8163841u) ^ ((uint32_t)z * 0xcb1ab31fu) ^ seed;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return h ^ (h >> 15);
}

/* Converts a hash to a number in [0, 1). */
static inline float noise_unit(uint32_t hash)
{
    return (float)(hash >> 8) * 0x1p-24f;
}

/* Returns gradient noise (Perlin 2002) in about [-1, 1], one feature a unit. */
float noise_gradient(vec3 p, uint32_t seed);
void noise_gradients(const lanes *p, uint32_t seed, float out[LANES]);

/* Computes three independent gradient noises a point. */
void noise_vectors(const lanes *p, uint32_t seed, lanes *out);

/* Returns a sum of octaves, each half as high and twice as fine, in about [-1, 1]. */
float noise_fbm(vec3 p, int octaves, uint32_t seed);
void noise_fbms(const lanes *p, int octaves, uint32_t seed, float out[LANES]);

/* Returns a sum of absolute octaves, in about [0, 1]: creases and veins. */
float noise_turbulence(vec3 p, int octaves, uint32_t seed);
void noise_turbulences(const lanes *p, int octaves, uint32_t seed, float out[LANES]);

typedef struct noise_cell {
    float first, second; /* distances to the nearest and the second nearest feature point */
    uint32_t id;         /* hash of the nearest one */
} noise_cell;

/* Returns cellular noise (Worley 1996), one feature point a unit cube. */
noise_cell noise_cellular(vec3 p, uint32_t seed);

typedef struct noise_cells {
    float first[LANES], second[LANES];
    uint32_t id[LANES];
} noise_cells;
void noise_cellulars(const lanes *p, uint32_t seed, noise_cells *out);

#endif
