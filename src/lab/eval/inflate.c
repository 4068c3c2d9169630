/* SPDX-License-Identifier: MIT */
#include "stereo/uncalibrated/inflate.h"
#include "lab/eval/metrics.h"
#include "lab/eval/trivial.h"
#include "optics/camera.h"
#include "optics/light.h"

status eval_inflate(const img *image, const img *mask, const eval_means *means, float fov, float power, eval_maps *out)
{
    *out = (eval_maps){0};
    status s = eval_maps_new(out, mask->width, mask->height);
    if (s != OK) return s;
    img_free(&out->normal);
    img height;
    s = pst_inflate(mask, &out->normal, &height);
    if (s != OK) {
        eval_maps_free(out);
        return s;
    }
    camera view = {.width = mask->width, .height = mask->height, .fov = fov};
    float size = camera_pixel_size(&view) * means->depth, middle = (float)img_mean_within(&height, mask);
    for (size_t i = 0, n = (size_t)mask->width * (size_t)mask->height; i < n; i++) {
        float depth = means->depth - size * (height.data[i] - middle);
        out->depth.data[i] = depth > 0.1f ? depth : 0.1f;
        out->roughness.data[i] = means->roughness;
        for (int c = 0; c < 3; c++) {
            float albedo = image->data[3 * i + (size_t)c] * BRDF_PI * depth * depth / power;
            out->albedo.data[3 * i + (size_t)c] = 2 * brdf_clamp(albedo, 0, 1) - 1;
        }
    }
    img_free(&height);
    return OK;
}
