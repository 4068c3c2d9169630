/* SPDX-License-Identifier: MIT */
/* Checks whether a list of lights has the camera's axes: other axes leave the same residual, but turn the surface, too,
 * whose normals then are not integrable, point inward at its outline, or face away from the camera. */
#ifndef MERLIN_STEREO_DOUBTS_LIGHT_TURNS_H
#define MERLIN_STEREO_DOUBTS_LIGHT_TURNS_H

#include "stereo/doubts/light_fit.h"

typedef struct pst_light_turn {
    double at[9]; /* row-major: the lights that fit, from those in the list */
    bool axes; /* whether `at` exchanges or reverses axes; else it is a rotation in the picture's plane, as follows */
    bool mirrored;  /* whether y is reversed first */
    double degrees; /* angle of the rotation, anticlockwise, in (-180, 180] */
    bool either;    /* mirrored: whether the pictures do not reveal if it is x or y */
    double better;  /* gain over the list as it is: above 0 if better */
    double hollow;  /* share of the outline where the list's own normals point steeply inward */
} pst_light_turn;

/* Finds the turn that fits best, other than none. b: the surface of pst_light_fit_surface. */
status pst_light_turn_find(const pst_light_fit *f, const vec3 *b, pst_light_turn *out);

#endif
