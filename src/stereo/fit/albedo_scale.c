/* SPDX-License-Identifier: MIT */
#include "stereo/fit/albedo_scale.h"
#include "base/number.h"

#include <math.h>
#include <stdlib.h>

#include "stereo/fit/pixel_fit.h"

enum { MOST_PIXELS = 1 << 15 };
static const float BRIGHT = 0.9f;

/* Samples pixels with all their channels, as a step over values could always meet the same channel. */
static size_t sample_values(const img *albedo, const img *mask, float *sample)
{
    size_t channels = (size_t)albedo->channels, pixels = img_value_count(mask), inside = 0, count = 0;
    for (size_t i = 0; i < pixels; i++)
        inside += mask->data[i] > 0.5f;
    for (size_t i = 0, met = 0, step = inside / MOST_PIXELS + 1; i < pixels; i++) {
        if (!(mask->data[i] > 0.5f) || met++ % step != 0) continue;
        for (size_t k = channels * i; k < channels * (i + 1); k++)
            if (isfinite(albedo->data[k])) sample[count++] = albedo->data[k];
    }
    return count;
}

status pst_albedo_scale(const img *albedo, const img *mask, float *scale)
{
    *scale = 1;
    float *sample = malloc((size_t)albedo->channels * MOST_PIXELS * sizeof *sample);
    if (!sample) return fail(MERLIN_NO_MEMORY, "no memory for the scale of an albedo");
    size_t count = sample_values(albedo, mask, sample);
    qsort(sample, count, sizeof *sample, number_ascending);
    float bright = count ? sample[count * 99 / 100] : 0;
    if (bright > 0) *scale = BRIGHT / bright;
    free(sample);
    return OK;
}

status pst_scale_albedo(img *albedo, const img *mask, float *scale)
{
    status s = pst_albedo_scale(albedo, mask, scale);
    if (s != OK) return s;
    for (size_t i = 0; i < img_value_count(albedo); i++) {
        float x = albedo->data[i] * *scale;
        albedo->data[i] = isfinite(x) && x > 0 ? (x < 1 ? x : 1) : 0;
    }
    return OK;
}
