/* SPDX-License-Identifier: MIT */
/* Intensities of distant lights of known direction, under Lambert's law: where the semi-calibrated solver starts.
 *
 *     double e[PST_MAX_LIGHTS], told;
 *     status s = pst_intensities_find(p, 240, e, &told); */
#ifndef MERLIN_STEREO_METHODS_INTENSITIES_H
#define MERLIN_STEREO_METHODS_INTENSITIES_H

#include "stereo/fit/problem.h"

/* e: one a light, their mean 1, from a sample of so many pixels. The problem's own intensities are divided out of the
 * pictures first. *told: how many times worse the next best explain the pictures; near 1 on a flat surface, where
 * intensities and albedo explain each other. */
status pst_intensities_find(const pst_problem *p, size_t sample, double *e, double *told);

/* Of the albedo: a pixel less bright says little of its light. */
#define PST_WELL_LIT 0.25f

/* The middle of most of the ratios, which it sorts: their median, then reweighted (Geman & McClure) about it. 1 if
 * there are none. */
double pst_intensities_typical(float *ratio, size_t count);

/* The same about another middle than the median: the nearest of several. */
double pst_intensities_about(const float *ratio, size_t count, double middle);

/* To the mean 1. */
void pst_intensities_normalize(double *e, int count);

#endif
