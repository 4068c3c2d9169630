/* SPDX-License-Identifier: MIT */
#include "stereo/integrate/surface_error.h"

#include <math.h>

static bool is_object(const merlin_capture *c, size_t pixel)
{
    return c->mask.data[pixel] > 0.5f;
}

double normal_mean_angle(const img *normal, const merlin_capture *c, size_t *pixels)
{
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0, total = (size_t)c->width * (size_t)c->height; i < total; i++) {
        vec3 truth = vec3_of(c->normal_true.data + 3 * i);
        if (!is_object(c, i) || vec3_length(truth) < 0.5f) continue;
        sum += vec3_angle(vec3_of(normal->data + 3 * i), truth);
        count++;
    }
    if (pixels) *pixels = count;
    return count ? sum / (double)count : 0;
}

double depth_mean_error(const img *depth, const merlin_capture *c)
{
    double product = 0, square = 0, off = 0, count = 0;
    size_t total = (size_t)c->width * (size_t)c->height;
    for (size_t i = 0; i < total; i++) {
        if (!is_object(c, i)) continue;
        product += (double)depth->data[i] * (double)c->depth_true.data[i];
        square += (double)depth->data[i] * (double)depth->data[i];
    }
    for (size_t i = 0; i < total; i++) {
        if (!is_object(c, i)) continue;
        off += fabs((double)depth->data[i] * product / square / (double)c->depth_true.data[i] - 1);
        count++;
    }
    return off / count;
}
