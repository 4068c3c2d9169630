/* SPDX-License-Identifier: MIT */
#include "photo_stereo/measured_albedo.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/number.h"

/* Rounds of the fit, each of which leaves out what differs by more than this from the last one: highlights and pixels
 * that hardly any light reached. */
enum { ROUNDS = 4 };
static const float far_off = 0.3f;

static bool is_measured(const merlin_image *measured, const merlin_maps *maps, size_t pixel, int channel)
{
    const float a = measured->data[pixel * (size_t)measured->channels + (size_t)channel];
    return maps->mask.data[pixel] >= 0.5f && isfinite(a) && a > 0;
}

/* Returns the present albedo that a channel is compared with. */
static float present(const merlin_image *measured, const merlin_maps *maps, size_t pixel, int channel)
{
    const float *a = maps->albedo.data + 3 * pixel;
    return measured->channels == 1 ? (a[0] + a[1] + a[2]) / 3 : a[channel];
}

/* Returns the geometric mean of the ratios to the present albedo, which few outliers hardly change; 0 of none. */
static float usual_ratio(const merlin_image *measured, const merlin_maps *maps, int channel)
{
    const size_t pixels = (size_t)measured->width * (size_t)measured->height;
    double sum = 0, count = 0;
    for (size_t i = 0; i < pixels; i++) {
        const float b = present(measured, maps, i, channel);
        if (!is_measured(measured, maps, i, channel) || !(b > 0)) continue;
        sum += log((double)(b / measured->data[i * (size_t)measured->channels + (size_t)channel]));
        count++;
    }
    return count > 0 ? (float)exp(sum / count) : 0;
}

/* Returns the factor with which a channel differs least from the present albedo; 0 if nothing was measured. */
static float scale_of(const merlin_image *measured, const merlin_maps *maps, int channel)
{
    const size_t pixels = (size_t)measured->width * (size_t)measured->height;
    float scale = usual_ratio(measured, maps, channel);
    for (int round = 0; round < ROUNDS; round++) {
        double both = 0, own = 0;
        for (size_t i = 0; i < pixels; i++) {
            if (!is_measured(measured, maps, i, channel)) continue;
            const float a = measured->data[i * (size_t)measured->channels + (size_t)channel];
            const float b = present(measured, maps, i, channel);
            if (fabsf(scale * a - b) > far_off) continue;
            both += (double)a * (double)b;
            own += (double)a * (double)a;
        }
        if (own > 0) scale = (float)(both / own);
    }
    return scale;
}

void measured_albedo_take(const merlin_image *measured, merlin_maps *maps)
{
    const int channels = measured->channels;
    const size_t pixels = (size_t)measured->width * (size_t)measured->height;
    float scale[3] = {0};
    for (int ch = 0; ch < channels; ch++)
        scale[ch] = scale_of(measured, maps, ch);
    for (size_t i = 0; i < pixels; i++) {
        const float before = present(measured, maps, i, 0);
        for (int ch = 0; ch < 3; ch++) {
            const int from = channels == 1 ? 0 : ch;
            if (!(scale[from] > 0) || !is_measured(measured, maps, i, from)) continue;
            const float a = scale[from] * measured->data[i * (size_t)channels + (size_t)from];
            float *to = maps->albedo.data + 3 * i + ch;
            *to = clamp(channels == 3 ? a : before > 0 ? a * *to / before : a, 0, 1);
        }
    }
}
