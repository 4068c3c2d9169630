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

noise_cell noise_cellular(vec3 p, uint32_t seed)
{
    float fx = floorf(p.x), fy = floorf(p.y), fz = floorf(p.z);
    float x = p.x - fx, y = p.y - fy, z = p.z - fz;
    noise_cell cell = {1e9f, 1e9f, 0};
    for (int c = 0; c < 27; c++) {
        int cx = c % 3 - 1, cy = c / 3 % 3 - 1, cz = c / 9 - 1;
        uint32_t h = noise_hash((int)fx + cx, (int)fy + cy, (int)fz + cz, seed);
        float dx = (float)cx + (float)(h & 1023) / 1023 - x, dy = (float)cy + (float)((h >> 10) & 1023) / 1023 - y;
        float dz = (float)cz + (float)((h >> 20) & 1023) / 1023 - z, d = dx * dx + dy * dy + dz * dz;
        if (d < cell.first) {
            cell.second = cell.first;
            cell.first = d;
            cell.id = h;
        } else if (d < cell.second) {
            cell.second = d;
        }
    }
    cell.first = sqrtf(cell.first);
    cell.second = sqrtf(cell.second);
    return cell;
}
