/* SPDX-License-Identifier: MIT */
/* Many pixels of a problem, and the result of each one's fit. */
#ifndef MERLIN_STEREO_FIT_FIELD_H
#define MERLIN_STEREO_FIT_FIELD_H

#include "stereo/fit/lobe.h"
#include "stereo/fit/problem.h"

typedef struct pst_field {
    const pst_problem *problem;
    const uint32_t *pixel; /* indices into the pictures */
    size_t count;
    const img *depth;       /* NULL: distant lights */
    float scale;            /* factor of depth */
    const pst_lobe *lobe;   /* NULL: Lambert's law only */
    const pst_lobe *second; /* lobe of pixels of another material; NULL: none */
    vec3 *b;                /* count, albedo times normal, facing either way; NULL: not needed */
    pst_shading *shading;   /* count; only with a lobe */
} pst_field;

/* Factor below which a shading's cost must be, relative to another's, to count as far better: by a third of an outlier,
 * or by half. */
#define PST_FAR_LESS 0.3f
static inline float pst_far_below(float cost)
{
    return cost > 2 * PST_FAR_LESS ? cost - PST_FAR_LESS : 0.5f * cost;
}

#endif
