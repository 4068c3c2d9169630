/* SPDX-License-Identifier: MIT */
/* Photometric stereo from random subsets of a capture: the paper's protocol draws 32 of 50 pictures, five times.
 *
 *     for (int i = 0; i < draw_count(&capture); i++) {
 *         merlin_surface found;
 *         status s = draw_solve(&capture, i, MERLIN_STEREO_AUTO, &found);
 *         ...
 *     }
 */
#ifndef MERLIN_PHOTO_STEREO_DRAWS_H
#define MERLIN_PHOTO_STEREO_DRAWS_H

#include "stereo/methods/solve.h"

enum { DRAW_MOST = 5, DRAW_PICTURES = 32 };

/* Returns DRAW_MOST, or 1 for a capture of at most DRAW_PICTURES, which is always used completely. */
int draw_count(const merlin_capture *all);
/* Solves subset number `draw`, the same for every capture of as many pictures. MERLIN_STEREO_UNCALIBRATED does not get
 * the lights. */
status draw_solve(const merlin_capture *all, int draw, merlin_stereo_method method, merlin_surface *out);

#endif
