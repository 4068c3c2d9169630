/* SPDX-License-Identifier: MIT */
/* Many pixels of a problem and what each one's fit found. */
#ifndef MERLIN_STEREO_FIT_FIELD_H
#define MERLIN_STEREO_FIT_FIELD_H

#include "stereo/fit/lobe.h"
#include "stereo/fit/problem.h"

typedef struct pst_field {
    const pst_problem *problem;
    const uint32_t *pixel; /* indices into the pictures */
    size_t count;
    const img *depth;       /* NULL: distant lights */
    float scale;            /* of depth */
    const pst_lobe *lobe;   /* NULL: Lambert's law alone */
    const pst_lobe *second; /* what pixels of another material have instead; NULL: none */
    vec3 *b;                /* count, albedo times normal, whichever way it faces; NULL: not asked for */
    pst_shading *shading;   /* count; with a lobe */
} pst_field;

/* Share of another's cost that a shading must cost less than to be taken for the better one by far: by a third of an
 * outlier, or by half. */
#define PST_FAR_LESS 0.3f
static inline float pst_far_below(float cost)
{
    return cost > 2 * PST_FAR_LESS ? cost - PST_FAR_LESS : 0.5f * cost;
}

#endif
