/* SPDX-License-Identifier: MIT */
#include "model/model_codes.h"

#include <math.h>

#include "model/sh_bands.h"

/* Encodes without fminf and fmaxf, which would be library calls because of what they promise about NaN. */
void model_encode_image(const float *linear, float *encoded, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        float v = linear[i] > 0 ? linear[i] : 0;
        encoded[i] = sqrtf(v < MODEL_BRIGHTEST ? v : MODEL_BRIGHTEST);
    }
}

float model_encode_strength(float strength)
{
    return log1pf(strength);
}

float model_decode_strength(float code)
{
    return code > 0 ? expm1f(code) : 0;
}

void model_sight(const camera *lens, bool flash, int size, float *out)
{
    const camera c = lens ? (camera){size, size, lens->fov, lens->slant} : (camera){0};
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++, out += MODEL_SIGHT) {
            vec3 ray = lens ? camera_point(&c, (float)x + 0.5f, (float)y + 0.5f, 1) : vec3_make(0, 0, -1);
            out[0] = ray.x;
            out[1] = ray.y;
            out[2] = lens != NULL;
            out[3] = flash;
        }
}

void model_encode_sh(const float sh[9][3], float code[MODEL_SH])
{
    for (int band = 0; band < SH_BANDS; band++)
        for (int i = sh_first[band]; i < sh_first[band] + sh_count[band]; i++)
            code[i] = sh[i / 3][i % 3] * sh_scale[band];
}

void model_decode_sh(const float code[MODEL_SH], float sh[9][3])
{
    for (int band = 0; band < SH_BANDS; band++)
        for (int i = sh_first[band]; i < sh_first[band] + sh_count[band]; i++)
            sh[i / 3][i % 3] = code[i] / sh_scale[band];
}

int model_light_size(const model_config *config)
{
    return config->lighting == MODEL_LIGHT_BOTH ? 3 + MODEL_SH : 3;
}
