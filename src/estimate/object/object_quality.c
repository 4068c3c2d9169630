/* SPDX-License-Identifier: MIT */
#include "estimate/object/object_quality.h"

#include <math.h>
#include <stddef.h>

#include "base/number.h"

static const float LARGEST_AREA = 0.9f;

/* Evaluates a logistic regression that was fitted to the candidates of 600 composites (merlin-lab eval masks), samples
 * 0 to 119 of seed 9400. docs/notes/masks.md states how often it is right. */
float object_quality(const object_cues *c)
{
    if (c->area < OBJECT_LEAST_AREA || c->area > LARGEST_AREA) return -INFINITY;
    const float area = logf(c->area);
    const struct {
        float cue, weight;
    } terms[] = {
        {c->edge, 3.0441f},
        {c->weak, -2.535f},
        {c->apart, 43.063f},
        {c->unsure, -15.911f},
        {fminf(c->top, 0.3f), -9.0268f},
        {fminf(c->sides, 0.3f), -2.6599f},
        {fminf(c->bottom, 0.5f), -1.8781f},
        {area, 0.15485f},
        {area * area, -0.066063f},
        {c->solid, -1.6038f},
        {sqrtf(fminf(c->compact, 1.5f)), 2.8151f},
        {c->centre, 0.18444f},
        {fminf(c->away, 1), 0.010513f},
        {fminf(c->near, 0.5f), -14.963f},
        {clamp(c->plain, -14, 0), 0.91532f},
        {c->dark, 0.49023f},
        {c->agree, 1.1875f},
        {c->agree * c->agree, 2.063f},
        {c->most_agree, 3.2246f},
        {powf(c->most_agree, 4), 3.3962f},
    };
    float sum = -41.2232f;
    for (size_t i = 0; i < sizeof terms / sizeof *terms; i++)
        sum += terms[i].cue * terms[i].weight;
    return sum;
}
