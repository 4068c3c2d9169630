/* SPDX-License-Identifier: MIT */
/* Photometric stereo from random subsets of a capture: the paper's protocol draws 32 of 50 pictures, five times.
 *
 *     for (int i = 0; i < subset_count(&capture, SUBSET_PICTURES); i++) {
 *         merlin_surface found;
 *         status s = subset_solve(&capture, i, MERLIN_STEREO_AUTO, &found);
 *         ...
 *     }
 */
#ifndef MERLIN_PHOTO_STEREO_SUBSETS_H
#define MERLIN_PHOTO_STEREO_SUBSETS_H

#include "stereo/methods/solve.h"

enum { SUBSETS = 5, SUBSET_PICTURES = 32 };

/* Returns SUBSETS, or 1 for a capture of at most so many pictures, which is always used completely. */
int subset_count(const merlin_capture *all, int pictures);
/* Makes subset number `subset` of so many pictures, the same for every capture of as many, which it borrows.
 * MERLIN_NO_MEMORY. */
status subset_new(const merlin_capture *all, int subset, int pictures, merlin_capture *out);
void subset_free(merlin_capture *subset);
/* Solves a subset as pst_solve_guided does. MERLIN_STEREO_UNCALIBRATED does not get the lights. */
status subset_solve_guided(const merlin_capture *all, int subset, int pictures, const merlin_stereo_params *params,
                           const pst_guide *guide, merlin_surface *out);
/* Solves subset number `subset` of SUBSET_PICTURES. */
status subset_solve(const merlin_capture *all, int subset, merlin_stereo_method method, merlin_surface *out);

#endif
