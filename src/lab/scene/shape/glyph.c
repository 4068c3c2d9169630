/* SPDX-License-Identifier: MIT */
#include "lab/scene/shape/glyph.h"

#include "base/number.h"
#include "lab/scene/shape/noise.h"

enum { ALPHABET = 24, STROKES = 4 };

static float segment_distance(float x, float y, const float a[2], const float b[2])
{
    float dx = b[0] - a[0], dy = b[1] - a[1], length = dx * dx + dy * dy;
    float t = length > 0 ? ((x - a[0]) * dx + (y - a[1]) * dy) / length : 0;
    t = clamp(t, 0, 1);
    return hypotf(x - a[0] - t * dx, y - a[1] - t * dy);
}

/* Returns one of the nine points of the letter's cell between which strokes run. */
static void lattice_point(uint32_t bits, float p[2])
{
    p[0] = 0.22f + 0.25f * (float)(bits % 3);
    p[1] = 0.18f + 0.32f * (float)(bits / 3 % 3);
}

float glyph_ink(float x, float y, float weight, uint32_t seed)
{
    float fx = floorf(x), fy = floorf(y);
    uint32_t place = noise_hash((int)fx, (int)fy, 0, seed);
    if (place % 5 == 0) return 0; /* the space between words */
    uint32_t letter = noise_hash((int)(place >> 8) % ALPHABET, 1, 2, seed);
    float distance = 1, from[2], to[2];
    x -= fx;
    y -= fy;
    lattice_point(letter % 9, from);
    for (int i = 0; i < STROKES; i++) {
        uint32_t bits = noise_hash(i, (int)(letter >> 16), 3, seed);
        lattice_point(bits >> 8, to);
        float d;
        if (bits % 4 == 0) { /* a ring around the middle of the stroke */
            float radius = 0.5f * min_of(0.4f, hypotf(to[0] - from[0], to[1] - from[1]));
            d = fabsf(hypotf(x - 0.5f * (from[0] + to[0]), y - 0.5f * (from[1] + to[1])) - radius);
        } else {
            d = segment_distance(x, y, from, to);
        }
        distance = min_of(distance, d);
        if (bits % 7 > 1) { /* most strokes continue where the last one ended */
            from[0] = to[0];
            from[1] = to[1];
        } else {
            lattice_point(bits >> 16, from);
        }
    }
    return 1 - smooth_step(0.75f * weight, 1.25f * weight, distance);
}
