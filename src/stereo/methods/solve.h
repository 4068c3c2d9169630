/* SPDX-License-Identifier: MIT */
/* Computes normals, albedo and depth from a capture.
 *
 *     merlin_surface surface;
 *     status s = pst_solve(&capture, &(merlin_stereo_params){.method = MERLIN_STEREO_AUTO}, &surface);
 *     merlin_surface_free(&surface);
 */
#ifndef MERLIN_STEREO_METHODS_SOLVE_H
#define MERLIN_STEREO_METHODS_SOLVE_H

#include "stereo/fit/problem.h"
#include "stereo/integrate/stereo_surface.h"
#include "stereo/methods/guide.h"

/* Fills all of the surface but its depth, unless the method finds that, too. MERLIN_STOPPED if params ask to stop. */
status pst_solve(const merlin_capture *c, const merlin_stereo_params *params, merlin_surface *out);
/* Does the same with what is expected from elsewhere; NULL: nothing. */
status pst_solve_expecting(const merlin_capture *c, const merlin_stereo_params *params, const pst_expected *expected,
                           merlin_surface *out);
/* Does the same with what a guide finds if the method is for near lights. guide NULL: without. */
status pst_solve_guided(const merlin_capture *c, const merlin_stereo_params *params, const pst_guide *guide,
                        merlin_surface *out);

#endif
