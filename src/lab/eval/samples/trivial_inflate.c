/* SPDX-License-Identifier: MIT */
#include "base/number.h"
#include "lab/eval/metrics/metrics.h"
#include "lab/eval/samples/trivial.h"
#include "optics/camera.h"
#include "optics/light.h"
#include "stereo/uncalibrated/inflate.h"

status eval_inflate(const eval_photo *photo, const img *mask, const eval_means *means, surface *out)
{
    img height = {0};
    status s = surface_new(mask->width, mask->height, out);
    if (s != OK) return s;
    img_free(&out->normal);
    s = pst_inflate(mask, &out->normal, &height);
    if (s != OK) {
        surface_free(out);
        return s;
    }
    const camera view = camera_through(photo->lens, mask->width, mask->height);
    float size = camera_pixel_size(&view) * means->depth, middle = (float)img_mean_within(&height, mask);
    for (size_t i = 0, n = (size_t)mask->width * (size_t)mask->height; i < n; i++) {
        float depth = means->depth - size * (height.data[i] - middle);
        out->depth.data[i] = depth > 0.1f ? depth : 0.1f;
        out->roughness.data[i] = means->roughness;
        float matte = photo->white * PI * depth * depth / LIGHT_POWER;
        for (size_t c = 3 * i; c < 3 * i + 3; c++)
            out->albedo.data[c] = clamp(matte * photo->picture.data[c], 0, 1);
    }
    img_free(&height);
    return OK;
}
