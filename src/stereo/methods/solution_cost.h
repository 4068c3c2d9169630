/* SPDX-License-Identifier: MIT */
/* How well the places that a solution gives the object's pixels explain the pictures: a measure by which solutions of
 * the same pictures under different lights, lenses or distances can be compared. Their residuals cannot, as each
 * solution chooses for itself how large they must be to count as outliers, which are left out.
 *
 *     double cost;
 *     status s = pst_solve(&capture, &params, &surface);
 *     if (s == OK) s = pst_solution_cost(&capture, &surface, &cost);
 */
#ifndef MERLIN_STEREO_METHODS_SOLUTION_COST_H
#define MERLIN_STEREO_METHODS_SOLUTION_COST_H

#include "stereo/capture/capture.h"
#include "stereo/integrate/stereo_surface.h"

/* Computes the mean over a sample of pixels of the robust loss of the best fit there (lobe_fit.h): 0 if all pictures
 * are explained, at most their number. c: the capture that was solved, under known lights. MERLIN_NO_MEMORY. */
status pst_solution_cost(const merlin_capture *c, const merlin_surface *found, double *cost);

#endif
