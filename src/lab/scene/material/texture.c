/* SPDX-License-Identifier: MIT */
#include "lab/scene/material/texture.h"

enum { PLANES = 3, MAX_CHANNELS = 3 };

/* Texture coordinates of a point on the three planes perpendicular to z, x and y. */
typedef struct planes {
    float u[PLANES], v[PLANES], weight[PLANES];
} planes;

static planes see(const texture_place *place, vec3 reference, vec3 facing)
{
    vec3 q = vec3_fma(place->offset, place->scale, mat3_apply(&place->turn, reference));
    vec3 f = mat3_apply(&place->turn, facing);
    planes p = {.u = {q.x, q.z, q.x}, .v = {q.y, q.y, q.z}};
    float sharp[PLANES] = {f.z * f.z, f.x * f.x, f.y * f.y}, sum = 0;
    for (int i = 0; i < PLANES; i++) {
        float s = sharp[i] * sharp[i];
        p.weight[i] = s * s; /* a high power, so that the planes' photographs rarely show through one another */
        sum += p.weight[i];
    }
    for (int i = 0; i < PLANES; i++)
        p.weight[i] = sum > 0 ? p.weight[i] / sum : 1.0f / PLANES;
    return p;
}

static int wrapped(int i, int n)
{
    i %= n;
    return i < 0 ? i + n : i;
}

/* Adds weight × the bilinear value at (u, v), in tile widths. */
static void add_tile(const img *tile, float u, float v, float weight, float out[MAX_CHANNELS])
{
    v *= (float)tile->width / (float)tile->height; /* pixels are square */
    float x = (u - floorf(u)) * (float)tile->width - 0.5f, y = (ceilf(v) - v) * (float)tile->height - 0.5f;
    int x0 = (int)floorf(x), y0 = (int)floorf(y);
    float fx = x - (float)x0, fy = y - (float)y0;
    for (int j = 0; j < 2; j++) {
        for (int i = 0; i < 2; i++) {
            const float *at = img_at(tile, wrapped(x0 + i, tile->width), wrapped(y0 + j, tile->height));
            float share = weight * (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
            for (int c = 0; c < tile->channels; c++)
                out[c] += share * at[c];
        }
    }
}

static void look_up(const img *tile, const planes *p, float out[MAX_CHANNELS])
{
    for (int i = 0; i < PLANES; i++)
        if (p->weight[i] > 1e-3f) add_tile(tile, p->u[i], p->v[i], p->weight[i], out);
}

vec3 texture_albedo(const texture_place *place, vec3 reference, vec3 facing)
{
    planes p = see(place, reference, facing);
    float rgb[MAX_CHANNELS] = {0};
    look_up(&place->texture->albedo, &p, rgb);
    return vec3_of(rgb);
}

float texture_roughness(const texture_place *place, vec3 reference, vec3 facing)
{
    planes p = see(place, reference, facing);
    float value[MAX_CHANNELS] = {0};
    look_up(&place->texture->roughness, &p, value);
    return value[0];
}

vec3 texture_gradient(const texture_place *place, vec3 reference, vec3 facing)
{
    planes p = see(place, reference, facing);
    float slope[PLANES][MAX_CHANNELS] = {{0}};
    for (int i = 0; i < PLANES; i++)
        if (p.weight[i] > 1e-3f) add_tile(&place->texture->slope, p.u[i], p.v[i], p.weight[i], slope[i]);
    vec3 g = {slope[0][0] + slope[2][0], slope[0][1] + slope[1][1], slope[1][0] + slope[2][1]};
    return mat3_apply_transposed(&place->turn, g); /* rotates back from the texture's axes */
}
