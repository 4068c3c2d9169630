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

/* Returns the sum of the channels' radiance, of a pixel of the input "image". */
static float light_of(const float *encoded)
{
    return encoded[0] * encoded[0] + encoded[1] * encoded[1] + encoded[2] * encoded[2];
}

void model_encode_shares(const float *images, int pictures, size_t pixels, float *shares)
{
    for (int k = 0; k < pictures; k++) {
        const float *image = images + 3 * pixels * (size_t)k;
        float *light = shares + pixels * (size_t)k;
        double sum = 0;
        for (size_t i = 0; i < pixels; i++)
            sum += (double)(light[i] = light_of(image + 3 * i));
        const float scale = sum > 0 ? (float)((double)pixels / sum) : 0;
        for (size_t i = 0; i < pixels; i++)
            light[i] *= scale;
    }
    for (size_t i = 0; i < pixels; i++) {
        float squares = 0;
        for (int k = 0; k < pictures; k++)
            squares += shares[pixels * (size_t)k + i] * shares[pixels * (size_t)k + i];
        const float mean = sqrtf(squares / (float)pictures);
        for (int k = 0; k < pictures; k++) {
            float *share = &shares[pixels * (size_t)k + i];
            *share = mean > 0 && pictures > 1 ? *share / mean - 1 : 0;
        }
    }
}
