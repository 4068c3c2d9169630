/* SPDX-License-Identifier: MIT */
#include "nfps/nfps_matte.h"

#include <math.h>
#include <string.h>

#include "model/nfps.h"
#include "nn/nn.h"
#include "stereo/algebra/matrix3.h"
#include "stereo/fit/normal_spread.h"
#include "stereo/fit/pixel_fit.h"

/* The spread that becomes one half, degrees. */
static const float HALF = 10;

static void fit_pixel(const nfps_scene *scene, const float *images, const float *strength, const float *light, size_t i,
                      float *to)
{
    float x[NN_LARGEST_GROUP] = {0}, y[NN_LARGEST_GROUP] = {0}, z[NN_LARGEST_GROUP] = {0};
    float value[NN_LARGEST_GROUP] = {0}, usable[NN_LARGEST_GROUP] = {0}, weight[NN_LARGEST_GROUP],
          fit[NN_LARGEST_GROUP];
    for (int k = 0; k < scene->pictures; k++) {
        const size_t at = (size_t)k * scene->pixels + i;
        const float *from = images + 3 * at, *toward = light + NFPS_LIGHT * at;
        x[k] = toward[0];
        y[k] = toward[1];
        z[k] = toward[2];
        value[k] = (from[0] + from[1] + from[2]) / strength[at];
        usable[k] = 1;
    }
    const pst_observations o = {pst_padded(scene->pictures), x, y, z, value, usable, 0};
    const pst_pixel p = pst_pixel_fit(&o, weight);
    for (int k = 0; k < o.padded; k++)
        fit[k] = fmaxf(p.b.x * x[k] + p.b.y * y[k] + p.b.z * z[k], 0);
    const float albedo = vec3_length(p.b), spread = pst_normal_spread(&o, weight, fit, vec3_normalize(p.b), albedo);
    vec3_put(pst_facing(p.b), to);
    to[3] = p.cost / (float)scene->pictures;
    to[4] = spread / (spread + HALF);
}

void nfps_matte(const nfps_scene *scene, const float *images, const float *strength, const float *light, float *matte)
{
    memset(matte, 0, NFPS_MATTE * scene->pixels * sizeof *matte);
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t i = 0; i < scene->pixels; i++)
        if (scene->mask[i] > 0.5f) fit_pixel(scene, images, strength, light, i, matte + NFPS_MATTE * i);
}
