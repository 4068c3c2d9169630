/* SPDX-License-Identifier: MIT */
/* Meters the brightness of a relighter's pictures before they are rendered. */
#include <math.h>
#include <stdlib.h>

#include "base/number.h"
#include "estimate/light/relight_env.h"
#include "estimate/relight/relighter.h"

/* Range of the histogram in stops above and below 1, with 32 bins each. */
enum { STOPS = 24, BINS_BY_STOP = 32, BINS = 2 * STOPS * BINS_BY_STOP };
/* Largest number of a dome's lamps that are evaluated, evenly chosen. */
enum { MOST_LAMPS = 100 };
static const double BRIGHTEST_SHARE = 0.001;

typedef struct histogram {
    size_t bins[BINS], count;
} histogram;

static void note(histogram *h, const img *radiance, const img *mask)
{
    for (size_t i = 0; i < img_value_count(radiance); i++) {
        if (mask->data[i / 3] < 0.5f) continue;
        float place = (log2f(fmaxf(radiance->data[i], 1e-12f)) + STOPS) * BINS_BY_STOP;
        h->bins[(int)clamp(place, 0, BINS - 1)]++;
        h->count++;
    }
}

/* Returns the upper end of the bin in which the brightest thousandth begins. */
static float bright_end(const histogram *h)
{
    size_t above = 0, wanted = (size_t)(BRIGHTEST_SHARE * (double)h->count);
    int bin = BINS - 1;
    while (bin > 0 && (above += h->bins[bin]) <= wanted)
        bin--;
    return exp2f((float)(bin + 1) / BINS_BY_STOP - STOPS);
}

static status note_lamp(const relighter *s, const lamp *l, histogram *h)
{
    img radiance = {0};
    status result = surface_shade_lamp(&s->low, l, &radiance);
    for (size_t i = 0; result == OK && i < img_value_count(&radiance); i += 3)
        vec3_put(vec3_mul(vec3_of(radiance.data + i), l->tint), radiance.data + i);
    if (result == OK && s->environment) surface_add_ambient(&s->low, (const float(*)[3])s->environment->sh, &radiance);
    if (result == OK) note(h, &radiance, &s->low.mask);
    img_free(&radiance);
    return result;
}

static status note_environment(const relighter *s, histogram *h)
{
    img radiance = {0};
    status result = img_new(&radiance, s->low.mask.width, s->low.mask.height, 3);
    if (result == OK) {
        surface_add_ambient(&s->low, (const float(*)[3])s->environment->sh, &radiance);
        note(h, &radiance, &s->low.mask);
    }
    img_free(&radiance);
    return result;
}

/* Returns the radiance of a white matte surface at (0, 0, -1) that faces the lamp. */
static float white_facing(const lamp *l)
{
    vec3 way = vec3_sub(l->at, vec3_make(0, 0, -1));
    float squared = l->distant ? 1 : fmaxf(vec3_dot(way, way), LIGHT_MIN_DISTANCE2);
    return LIGHT_POWER / PI * fmaxf(fmaxf(l->tint.x, l->tint.y), l->tint.z) / squared;
}

status relighter_meter(const relighter *s, const lamp *lamps, size_t count, float *white)
{
    histogram *h = calloc(1, sizeof *h);
    if (!h) return fail(MERLIN_NO_MEMORY, "no memory to measure an exposure");
    size_t step = (count + MOST_LAMPS - 1) / MOST_LAMPS;
    float facing = 0;
    status result = OK;
    for (size_t i = 0; i < count && result == OK; i += step) {
        result = note_lamp(s, &lamps[i], h);
        facing = fmaxf(facing, white_facing(&lamps[i]));
    }
    if (result == OK && count == 0 && s->environment) result = note_environment(s, h);
    *white = fmaxf(bright_end(h), facing);
    free(h);
    return result;
}
