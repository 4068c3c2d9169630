/* SPDX-License-Identifier: MIT */
/* The last step of uncalibrated photometric stereo with distant lights: resolves the rotation or reflection up to which
 * the surface is known.
 *
 * Normals of a surface are integrable (A. Yuille, D. Snow, Shape and albedo from multiple images using integrability,
 * CVPR 1997): that determines the rotation, searched for among those that leave the lights' mean on the camera's side,
 * except for a sign, convex or concave. Shadows, highlights and perspective distort it. Therefore, the worse the best
 * rotation is, the more weight a second prior has: the object is similar to its inflated outline (inflate.h). That
 * determines the sign, too. */
#ifndef MERLIN_STEREO_UNCALIBRATED_INTEGRABLE_H
#define MERLIN_STEREO_UNCALIBRATED_INTEGRABLE_H

#include "stereo/fit/problem.h"

/* Largest share of a surface's pixels that face away, as visible pixels face the camera. With correct lights up to a
 * twentieth do because of noise; with wrong ones, half. */
#define PST_MOST_AWAY 0.25
/* Least number of pixels from which lights are found. */
enum { PST_FEWEST_PIXELS = 100 };

/* A surface up to a 3×3 matrix, and its pixels' positions. */
typedef struct pst_pseudo {
    const pst_problem *problem;
    const img *inflated; /* unit normals of the inflated outline (inflate.h) */
    vec3 *b;             /* one per pixel of the problem */
    int32_t *slot;       /* index by position in the picture, -1 outside the mask */
} pst_pseudo;

typedef struct pst_rotation {
    double at[9]; /* row-major, of determinant 1 or -1 */
    bool unsure;  /* whether the most integrable rotation is hardly integrable, has much of the surface facing away, or
                   * differs much from the one with the inflated outline, or neither sign is similar to that */
    bool uneven;  /* whether lights that were found with what is expected are not equally strong */
} pst_rotation;

static inline vec3 pst_transform(const double m[9], vec3 v)
{
    return vec3_make((float)(m[0] * v.x + m[1] * v.y + m[2] * v.z), (float)(m[3] * v.x + m[4] * v.y + m[5] * v.z),
                     (float)(m[6] * v.x + m[7] * v.y + m[8] * v.z));
}

/* Replaces f->b by its mean over a neighbourhood, as between adjacent pixels the surface turns by less than the noise.
 */
status pst_average_surface(const pst_pseudo *f);

/* Finds the rotation; f->b, known up to a rotation or reflection, is replaced by its mean over a neighbourhood.
 * mean_light: of the lights in b's space. MERLIN_BAD_INPUT if the mask is too thin, or no rotation leaves the lights in
 * front of the object. */
status pst_find_rotation(const pst_pseudo *f, vec3 mean_light, pst_rotation *out);

/* Fails with MERLIN_BAD_INPUT and a message. */
status pst_too_thin(void);

#endif
