/* SPDX-License-Identifier: MIT */
#include "sequence/sequence_exposure.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/number.h"

/* Most pixels whose median is taken, and fewest that tell anything. */
enum { MOST_SAMPLES = 16384, FEWEST_SAMPLES = 64 };
/* Encoded values between which a pixel tells the exposure: darker ones are noise, brighter ones may be burnt out. */
static const float DARKEST = 0.08f, BRIGHTEST = 0.97f;

status sequence_encode(const img *photo, img *out)
{
    status s = img_new(out, photo->width, photo->height, photo->channels);
    for (size_t i = 0; s == OK && i < img_value_count(photo); i++)
        out->data[i] = photo->data[i] > 0 ? sqrtf(photo->data[i]) : 0;
    return s;
}

status sequence_grey(const img *encoded, float factor, img *out)
{
    const float third = sqrtf(factor) / 3;
    status s = img_new(out, encoded->width, encoded->height, 1);
    const size_t pixels = (size_t)encoded->width * (size_t)encoded->height;
    for (size_t i = 0; s == OK && i < pixels; i++) {
        const float *value = encoded->data + 3 * i;
        out->data[i] = third * (value[0] + value[1] + value[2]);
    }
    return s;
}

void sequence_scale(img *encoded, const float factor[3])
{
    const float roots[3] = {sqrtf(factor[0]), sqrtf(factor[1]), sqrtf(factor[2])};
    for (size_t i = 0; i < img_value_count(encoded); i++)
        encoded->data[i] *= roots[i % 3];
}

static float light_of(const float *encoded)
{
    return encoded[0] * encoded[0] + encoded[1] * encoded[1] + encoded[2] * encoded[2];
}

float sequence_brightness(const img *before, const img *now, const img *mask, sequence_shift by)
{
    double then = 0, today = 0;
    for (int y = 0; y < mask->height; y++) {
        const img_span s = img_row_span(mask, y);
        for (int x = s.first; x < s.end && y + by.y >= 0 && y + by.y < now->height; x++) {
            if (*img_at(mask, x, y) < 0.5f || x + by.x < 0 || x + by.x >= now->width) continue;
            then += (double)light_of(img_at(before, x, y));
            today += (double)light_of(img_at(now, x + by.x, y + by.y));
        }
    }
    return then > 0 && today > 0 ? (float)(then / today) : 1;
}

float sequence_median(float *values, size_t count)
{
    if (!count) return 0;
    qsort(values, count, sizeof *values, number_ascending);
    return values[count / 2];
}

void sequence_factors(const img *before, const img *now, const img *mask, float factor[3])
{
    static const float none = 1;
    const size_t pixels = (size_t)mask->width * (size_t)mask->height;
    float *ratios = malloc(3 * sizeof(float) * MOST_SAMPLES);
    size_t covered = 0, count[3] = {0};
    for (size_t i = 0; i < pixels; i++)
        covered += mask->data[i] >= 0.9f;
    const size_t step = covered / MOST_SAMPLES + 1;
    size_t seen = 0;
    for (size_t i = 0; ratios && i < pixels; i++) {
        if (mask->data[i] < 0.9f || seen++ % step) continue;
        for (size_t c = 0; c < 3; c++) {
            const float a = before->data[3 * i + c], b = now->data[3 * i + c];
            if (a > DARKEST && a < BRIGHTEST && b > DARKEST && b < BRIGHTEST)
                ratios[c * MOST_SAMPLES + count[c]++] = 2 * logf(a / b);
        }
    }
    for (size_t c = 0; c < 3; c++)
        factor[c] = count[c] >= FEWEST_SAMPLES ? expf(sequence_median(ratios + c * MOST_SAMPLES, count[c])) : none;
    free(ratios);
}

void sequence_expose(img *photo, const float factor[3])
{
    const float white = 1, below_white = 0.975f; /* what exposure_burnt_out takes for white begins above */
    bool bright = false;
    for (size_t i = 0; i < img_value_count(photo); i++)
        bright |= photo->data[i] > 1.01f;
    for (size_t i = 0; i < img_value_count(photo); i++) {
        const float value = photo->data[i], scaled = value * factor[i % 3];
        if (bright)
            photo->data[i] = scaled;
        else if (value < below_white)
            photo->data[i] = fminf(scaled, below_white);
        else
            photo->data[i] = fmaxf(value, fminf(scaled, white));
    }
}
