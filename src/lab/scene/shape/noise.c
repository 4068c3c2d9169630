/* SPDX-License-Identifier: MIT */
#include "lab/scene/shape/noise.h"

#include <stdbool.h>

ALWAYS_INLINE float fade(float t)
{
    return t * t * t * (t * (t * 6 - 15) + 10);
}

/* Points relative to their lattice cubes. */
typedef struct cube {
    int ix, iy, iz;
    float x, y, z;
} cube;

typedef struct cubes {
    int ix[LANES], iy[LANES], iz[LANES];
    float x[LANES], y[LANES], z[LANES];
} cubes;

ALWAYS_INLINE cube cube_of(vec3 p)
{
    float fx = floorf(p.x), fy = floorf(p.y), fz = floorf(p.z);
    return (cube){(int)fx, (int)fy, (int)fz, p.x - fx, p.y - fy, p.z - fz};
}

/* Returns the contribution of the cube's corner at (cx, cy, cz): the dot product of its gradient and the offset from
 * it. */
ALWAYS_INLINE float corner(cube q, int cx, int cy, int cz, uint32_t seed)
{
    uint32_t h = noise_hash(q.ix + cx, q.iy + cy, q.iz + cz, seed);
    float gx = (float)(int)(h & 1023) - 511.5f, gy = (float)(int)((h >> 10) & 1023) - 511.5f;
    float gz = (float)(int)((h >> 20) & 1023) - 511.5f;
    return gx * (q.x - (float)cx) + gy * (q.y - (float)cy) + gz * (q.z - (float)cz);
}

/* Interpolates along the edge in x through (cy, cz). */
ALWAYS_INLINE float edge(cube q, int cy, int cz, float u, uint32_t seed)
{
    float a = corner(q, 0, cy, cz, seed), b = corner(q, 1, cy, cz, seed);
    return a + u * (b - a);
}

ALWAYS_INLINE float gradient(cube q, uint32_t seed)
{
    float u = fade(q.x), v = fade(q.y), w = fade(q.z);
    float a = edge(q, 0, 0, u, seed), b = edge(q, 1, 0, u, seed);
    float c = edge(q, 0, 1, u, seed), d = edge(q, 1, 1, u, seed);
    float front = a + v * (b - a), back = c + v * (d - c);
    return (front + w * (back - front)) * (1.2f / 511.5f);
}

float noise_gradient(vec3 p, uint32_t seed)
{
    return gradient(cube_of(p), seed);
}

void noise_gradients(const lanes *p, uint32_t seed, float out[LANES])
{
#pragma omp simd
    for (int i = 0; i < LANES; i++)
        out[i] = gradient(cube_of(lanes_at(p, i)), seed);
}

void noise_vectors(const lanes *p, uint32_t seed, lanes *out)
{
    noise_gradients(p, seed, out->x);
    noise_gradients(p, seed + 0x68bc21ebu, out->y);
    noise_gradients(p, seed + 0x02e5be93u, out->z);
}

/* Ratio of the octaves' frequencies: not exactly 2, so that their lattice planes do not coincide. */
static const float lacunarity = 2.03f;

float noise_fbm(vec3 p, int octaves, uint32_t seed)
{
    float sum = 0, height = 1, total = 0;
    for (int i = 0; i < octaves; i++) {
        sum += height * noise_gradient(p, seed + (uint32_t)i);
        total += height;
        height *= 0.5f;
        p = vec3_scale(p, lacunarity);
    }
    return sum / total;
}

float noise_turbulence(vec3 p, int octaves, uint32_t seed)
{
    float sum = 0, height = 1, total = 0;
    for (int i = 0; i < octaves; i++) {
        sum += height * fabsf(noise_gradient(p, seed + (uint32_t)i));
        total += height;
        height *= 0.5f;
        p = vec3_scale(p, lacunarity);
    }
    return sum / total;
}

/* Sums octaves of the noise or of its absolute value. */
static void octaves_of(const lanes *p, int octaves, uint32_t seed, bool absolute, float out[LANES])
{
    lanes q = *p;
    float height = 1, total = 0, value[LANES];
    for (int i = 0; i < LANES; i++)
        out[i] = 0;
    for (int k = 0; k < octaves; k++) {
        noise_gradients(&q, seed + (uint32_t)k, value);
#pragma omp simd
        for (int i = 0; i < LANES; i++) {
            out[i] += height * (absolute ? fabsf(value[i]) : value[i]);
            lanes_put(&q, i, vec3_scale(lanes_at(&q, i), lacunarity));
        }
        total += height;
        height *= 0.5f;
    }
    for (int i = 0; i < LANES; i++)
        out[i] /= total;
}

void noise_fbms(const lanes *p, int octaves, uint32_t seed, float out[LANES])
{
    octaves_of(p, octaves, seed, false, out);
}

void noise_turbulences(const lanes *p, int octaves, uint32_t seed, float out[LANES])
{
    octaves_of(p, octaves, seed, true, out);
}

/* Cells around a point's own, padded to a whole number of vectors by cells so far away that they never matter. */
enum { CELLS = 27, PADDED = 32, AWAY = 1000 };
static const int cell_x[PADDED] = {-1, 0, 1,  -1, 0, 1,  -1, 0, 1,  -1, 0, 1,    -1,   0,    1,    -1,
                                   0,  1, -1, 0,  1, -1, 0,  1, -1, 0,  1, AWAY, AWAY, AWAY, AWAY, AWAY};
static const int cell_y[PADDED] = {-1, -1, -1, 0, 0,  0,  1,  1, 1, -1, -1, -1, 0, 0,
                                   0,  1,  1,  1, -1, -1, -1, 0, 0, 0,  1,  1,  1};
static const int cell_z[PADDED] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0, 0, 0,
                                   0,  0,  0,  0,  1,  1,  1,  1,  1,  1, 1, 1, 1};

/* Returns the squared distance to the feature point of the cell at offset x, y, z, and its hash. */
ALWAYS_INLINE float feature_distance(cube q, int x, int y, int z, uint32_t seed, uint32_t *id)
{
    uint32_t h = noise_hash(q.ix + x, q.iy + y, q.iz + z, seed);
    const float unit = 1.0f / 1023;
    float dx = (float)x + (float)(int)(h & 1023) * unit - q.x;
    float dy = (float)y + (float)(int)((h >> 10) & 1023) * unit - q.y;
    float dz = (float)z + (float)(int)((h >> 20) & 1023) * unit - q.z;
    *id = h;
    return dx * dx + dy * dy + dz * dz;
}

noise_cell noise_cellular(vec3 p, uint32_t seed)
{
    cube q = cube_of(p);
    float distance[PADDED];
    uint32_t id[PADDED];
#pragma omp simd
    for (int c = 0; c < PADDED; c++)
        distance[c] = feature_distance(q, cell_x[c], cell_y[c], cell_z[c], seed, &id[c]);
    float first = 1e9f, second = 1e9f;
    int nearest = 0;
    for (int c = 0; c < CELLS; c++) {
        float d = distance[c];
        second = d < second ? (d < first ? first : d) : second;
        nearest = d < first ? c : nearest;
        first = d < first ? d : first;
    }
    return (noise_cell){sqrtf(first), sqrtf(second), id[nearest]};
}

/* Updates the two nearest features by the feature point of one of the cells around each point. */
static void meet_cell(const cubes *q, int x, int y, int z, uint32_t seed, noise_cells *out)
{
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        cube at = {q->ix[i], q->iy[i], q->iz[i], q->x[i], q->y[i], q->z[i]};
        uint32_t h;
        float d = feature_distance(at, x, y, z, seed, &h), first = out->first[i], second = out->second[i];
        float between = d < first ? first : d;
        out->second[i] = d < second ? between : second;
        out->id[i] = d < first ? h : out->id[i];
        out->first[i] = d < first ? d : first;
    }
}

void noise_cellulars(const lanes *p, uint32_t seed, noise_cells *out)
{
    cubes q;
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        cube at = cube_of(lanes_at(p, i));
        q.ix[i] = at.ix;
        q.iy[i] = at.iy;
        q.iz[i] = at.iz;
        q.x[i] = at.x;
        q.y[i] = at.y;
        q.z[i] = at.z;
        out->first[i] = out->second[i] = 1e9f;
        out->id[i] = 0;
    }
    for (int c = 0; c < CELLS; c++)
        meet_cell(&q, cell_x[c], cell_y[c], cell_z[c], seed, out);
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        out->first[i] = sqrtf(out->first[i]);
        out->second[i] = sqrtf(out->second[i]);
    }
}
