/* SPDX-License-Identifier: MIT */
/* Intensities of distant lights of known direction by Lambert's law, where the semi-calibrated solver starts.
 *
 *     double e[PST_MAX_LIGHTS], uniqueness;
 *     status s = pst_intensities_find(p, 240, e, &uniqueness);
 */
#ifndef MERLIN_STEREO_METHODS_INTENSITIES_H
#define MERLIN_STEREO_METHODS_INTENSITIES_H

#include "stereo/fit/problem.h"

/* Finds the intensities e, one per light with mean 1, from a sample of this many pixels. The pictures are first divided
 * by the problem's own intensities. *uniqueness: by which factor the next best ones explain the pictures less well;
 * near 1 on a flat surface, where intensities and albedo are ambiguous. */
status pst_intensities_find(const pst_problem *p, size_t sample, double *e, double *uniqueness);

/* Least brightness in units of the albedo for a pixel to be informative about its light. */
#define PST_WELL_LIT 0.25f

/* Returns a robust centre of the ratios, which it sorts: their median, then reweighted (Geman & McClure) around it. 1
 * if there are none. */
double pst_intensities_typical(float *ratio, size_t count);

/* Does the same around another centre than the median: the nearest of several. */
double pst_intensities_about(const float *ratio, size_t count, double middle);

/* Scales the intensities to the mean 1. */
void pst_intensities_normalize(double *e, int count);

#endif
