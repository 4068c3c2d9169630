/* SPDX-License-Identifier: MIT */
/* The last step to the lights of uncalibrated: a surface that is known up to a rotation or reflection is turned to what
 * it must be to be one.
 *
 * Normals of a surface are integrable (A. Yuille, D. Snow, Shape and albedo from multiple images using integrability,
 * CVPR 1997): that fixes the rotation, searched for among those that leave the lights' mean on the camera's side, but
 * for a sign, convex or concave. Shadows, highlights and a camera's curve bend it. So the worse the best rotation is,
 * the more counts a second prior: the object is like a balloon of its outline. That tells the sign, too. */
#ifndef MERLIN_STEREO_UNCALIBRATED_INTEGRABLE_H
#define MERLIN_STEREO_UNCALIBRATED_INTEGRABLE_H

#include "stereo/fit/problem.h"

/* Of a surface's pixels, at most, that face away: what is seen faces the camera. Where lights were found, up to a
 * twentieth do, by noise; where they were not, half. */
#define PST_MOST_AWAY 0.25
/* Fewer pixels have no lights found by them. */
enum { PST_FEWEST_PIXELS = 100 };

/* A surface up to a 3×3 matrix, and where its pixels are. */
typedef struct pst_pseudo {
    const pst_problem *problem;
    const img *balloon; /* unit normals of the outline's (inflate.h) */
    vec3 *b;            /* a pixel of the problem */
    int32_t *slot;      /* picture position to that, -1 outside the mask */
} pst_pseudo;

typedef struct pst_rotation {
    double at[9]; /* row-major, of determinant 1 or -1 */
    bool unsure; /* the most integrable rotation is hardly integrable, has much of the surface face away, or is far from
                  * the one that the balloon makes of it, or neither sign is like the balloon */
} pst_rotation;

static inline vec3 pst_transform(const double m[9], vec3 v)
{
    return vec3_make((float)(m[0] * v.x + m[1] * v.y + m[2] * v.z), (float)(m[3] * v.x + m[4] * v.y + m[5] * v.z),
                     (float)(m[6] * v.x + m[7] * v.y + m[8] * v.z));
}

/* f->b, up to a rotation or reflection, becomes its mean over a neighbourhood. mean_light: of the lights in b's space.
 * MERLIN_BAD_INPUT if the mask is too thin, or no rotation leaves the lights before the object. */
status pst_find_rotation(const pst_pseudo *f, vec3 mean_light, pst_rotation *out);

/* MERLIN_BAD_INPUT, in words. */
status pst_too_thin(void);

#endif
