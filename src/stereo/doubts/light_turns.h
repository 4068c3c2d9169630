/* SPDX-License-Identifier: MIT */
/* Tells whether a list of lights has the camera's axes: turned ones leave the same residual and a surface that is
 * turned as well, which then has normals that are no surface's, point inward at its outline, or face away from the
 * camera. */
#ifndef MERLIN_STEREO_DOUBTS_LIGHT_TURNS_H
#define MERLIN_STEREO_DOUBTS_LIGHT_TURNS_H

#include "stereo/doubts/light_fit.h"

typedef struct pst_light_turn {
    double at[9];   /* row-major: the lights that fit, from those in the list */
    bool axes;      /* at exchanges or reverses axes; else it is in the picture's plane, as follows */
    bool mirrored;  /* y is reversed first */
    double degrees; /* of the turn, anticlockwise, in (-180, 180] */
    bool either;    /* mirrored: the pictures do not tell whether it is x or y */
    double better;  /* than the list as it is: above 0 if so */
    double hollow;  /* the share of the outline where the list's own normals point steeply inward */
} pst_light_turn;

/* The turn that fits best, other than none. b: pst_light_fit_surface's. */
status pst_light_turn_find(const pst_light_fit *f, const vec3 *b, pst_light_turn *out);

#endif
