#include "scene/noise.h"

static float fade(float t)
{
    return t * t * t * (t * (t * 6 - 15) + 10);
}

float noise_gradient(vec3 p, uint32_t seed)
{
    float fx = floorf(p.x), fy = floorf(p.y), fz = floorf(p.z);
    float x = p.x - fx, y = p.y - fy, z = p.z - fz;
    int ix = (int)fx, iy = (int)fy, iz = (int)fz;
    float n[8];
#pragma omp simd
    for (int c = 0; c < 8; c++) {
        int cx = c & 1, cy = (c >> 1) & 1, cz = c >> 2;
        uint32_t h = noise_hash(ix + cx, iy + cy, iz + cz, seed);
        float gx = (float)(int)(h & 1023) - 511.5f, gy = (float)(int)((h >> 10) & 1023) - 511.5f;
        float gz = (float)(int)((h >> 20) & 1023) - 511.5f;
        n[c] = gx * (x - (float)cx) + gy * (y - (float)cy) + gz * (z - (float)cz);
    }
    float u = fade(x), v = fade(y), w = fade(z);
    float a = n[0] + u * (n[1] - n[0]), b = n[2] + u * (n[3] - n[2]);
    float c = n[4] + u * (n[5] - n[4]), d = n[6] + u * (n[7] - n[6]);
    float front = a + v * (b - a), back = c + v * (d - c);
    return (front + w * (back - front)) * (1.2f / 511.5f);
}

vec3 noise_vector(vec3 p, uint32_t seed)
{
    return vec3_make(noise_gradient(p, seed), noise_gradient(p, seed + 0x68bc21ebu),
                     noise_gradient(p, seed + 0x02e5be93u));
}

float noise_fbm(vec3 p, int octaves, uint32_t seed)
{
    float sum = 0, height = 1, total = 0;
    for (int i = 0; i < octaves; i++) {
        sum += height * noise_gradient(p, seed + (uint32_t)i);
        total += height;
        height *= 0.5f;
        p = vec3_scale(p, 2.03f); /* not exactly 2, so that lattice planes of the octaves do not fall together */
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
        p = vec3_scale(p, 2.03f);
    }
    return sum / total;
}

/* The cells around a point's own, and behind them some so far away that they never matter: a whole number of vectors.
 */
enum { CELLS = 27, LANES = 32, AWAY = 1000 };
static const int cell_x[LANES] = {-1, 0, 1,  -1, 0, 1,  -1, 0, 1,  -1, 0, 1,    -1,   0,    1,    -1,
                                  0,  1, -1, 0,  1, -1, 0,  1, -1, 0,  1, AWAY, AWAY, AWAY, AWAY, AWAY};
static const int cell_y[LANES] = {-1, -1, -1, 0, 0,  0,  1,  1, 1, -1, -1, -1, 0, 0,
                                  0,  1,  1,  1, -1, -1, -1, 0, 0, 0,  1,  1,  1};
static const int cell_z[LANES] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0, 0, 0,
                                  0,  0,  0,  0,  1,  1,  1,  1,  1,  1, 1, 1, 1};

noise_cell noise_cellular(vec3 p, uint32_t seed)
{
    float fx = floorf(p.x), fy = floorf(p.y), fz = floorf(p.z);
    float x = p.x - fx, y = p.y - fy, z = p.z - fz, distance[LANES];
    int ix = (int)fx, iy = (int)fy, iz = (int)fz;
    uint32_t id[LANES];
#pragma omp simd
    for (int c = 0; c < LANES; c++) {
        uint32_t h = noise_hash(ix + cell_x[c], iy + cell_y[c], iz + cell_z[c], seed);
        float dx = (float)cell_x[c] + (float)(int)(h & 1023) / 1023 - x;
        float dy = (float)cell_y[c] + (float)(int)((h >> 10) & 1023) / 1023 - y;
        float dz = (float)cell_z[c] + (float)(int)((h >> 20) & 1023) / 1023 - z;
        distance[c] = dx * dx + dy * dy + dz * dz;
        id[c] = h;
    }
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
