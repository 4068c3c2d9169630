/* SPDX-License-Identifier: MIT */
#include "estimate/surface/exposure.h"

#include <math.h>

#include "base/number.h"
#include "image/color.h"

enum { BINS = 1536 };
/* Range of the histogram of luminance: 2^-24 to 2^24, with 32 bins per stop. */
static const float LOWEST_STOP = -24.0f, BINS_PER_STOP = 32.0f;
static const float PERCENTILE = 0.95f;
/* Range of that percentile in the training data: its 10th percentile over samples, and its 90th reduced to what the
 * brightest white leaves of it. */
static const float DARK_END = 0.34f, BRIGHT_END = 2.2f;

static float bright_luminance(const img *color, const img *mask)
{
    size_t bins[BINS] = {0}, count = 0, pixels = (size_t)color->width * (size_t)color->height;
    for (size_t i = 0; i < pixels; i++) {
        if (!(mask->data[i] >= 0.5f)) continue;
        float place = (log2f(fmaxf(color_luminance(color->data + 3 * i), 1e-9f)) - LOWEST_STOP) * BINS_PER_STOP;
        bins[(int)clamp(place, 0, BINS - 1)]++;
        count++;
    }
    size_t below = 0, wanted = (size_t)(PERCENTILE * (float)count);
    int bin = 0;
    while (bin < BINS - 1 && (below += bins[bin]) <= wanted)
        bin++;
    return bin == 0 ? 0 : exp2f(((float)bin + 0.5f) / BINS_PER_STOP + LOWEST_STOP);
}

float exposure_gain(const img *color, const img *mask)
{
    float bright = EXPOSURE_WHITE * bright_luminance(color, mask), change = 1;
    if (bright > 0 && bright < DARK_END) change = DARK_END / bright;
    if (bright > BRIGHT_END) change = BRIGHT_END / bright;
    float most = exp2f(EXPOSURE_MOST_EV);
    return EXPOSURE_WHITE * fminf(fmaxf(change, 1 / most), most);
}

/* Limit of values that count as 1, with room for rounding errors. */
static const float BEYOND_WHITE = 1.01f;

static bool is_beyond_white(const img *photo)
{
    for (size_t i = 0; i < img_value_count(photo); i++)
        if (photo->data[i] > BEYOND_WHITE) return true;
    return false;
}

float exposure_white(const img *photo, float gain)
{
    return gain < EXPOSURE_WHITE && is_beyond_white(photo) ? EXPOSURE_WHITE : gain;
}

float exposure_limit(const img *photo, float gain)
{
    return is_beyond_white(photo) ? INFINITY : gain;
}

float exposure_burnt_out(const img *color, const img *mask)
{
    const float limit = 0.98f; /* 253 of 255, as JPEG leaves white slightly darker */
    size_t burnt_out = 0, count = 0, pixels = (size_t)color->width * (size_t)color->height;
    for (size_t i = 0; i < pixels; i++) {
        if (!(mask->data[i] >= 0.999f)) continue;
        const float *value = color->data + 3 * i;
        for (int c = 0; c < 3; c++)
            burnt_out += value[c] >= limit && value[c] <= BEYOND_WHITE;
        count += 3;
    }
    return count ? (float)burnt_out / (float)count : 0;
}

float exposure_from_ev(float ev)
{
    return EXPOSURE_WHITE * exp2f(ev);
}

bool exposure_is_sound(float gain)
{
    return gain >= exposure_from_ev(-EXPOSURE_MOST_EV) && gain <= exposure_from_ev(EXPOSURE_MOST_EV);
}
