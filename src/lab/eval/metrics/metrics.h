/* SPDX-License-Identifier: MIT */
/* The paper's measures of a material estimate and of a relit picture.
 *
 *     double error = eval_mse(&albedo, &truth.albedo, &mask);
 *     double degrees = eval_angle(&normal, &truth.normal, &mask);
 *     double similarity;
 *     status s = eval_ssim(&relit, &target, &similarity);
 *
 * A pixel belongs to the object where the mask is above EVAL_MASK_LEVEL. Sums are in double and in a fixed order, so
 * that a figure does not depend on the number of threads. */
#ifndef MERLIN_LAB_EVAL_METRICS_METRICS_H
#define MERLIN_LAB_EVAL_METRICS_METRICS_H

#include "image/image.h"

#define EVAL_MASK_LEVEL 0.5f
/* A squared error of values in [0, 1] times this is that in [-1, 1], as the paper has it of albedo and roughness. */
#define EVAL_UNIT 4.0

/* Mean squared difference over the mask's pixels and all channels; 0 for an empty mask. a and b share size and
 * channels, mask has one channel and their size. The paper's tables print this times 100, for albedo and roughness in
 * [-1, 1] (EVAL_UNIT), unit normals and depth in scene units. */
double eval_mse(const img *a, const img *b, const img *mask);

/* Returns the same after a was multiplied by the factor with which it is least. */
double eval_mse_scale_free(const img *a, const img *b, const img *mask);

/* Mean angle in degrees between unit vectors (3 channels) over the mask's pixels; 0 for an empty mask. */
double eval_angle(const img *a, const img *b, const img *mask);

/* Median of count values, which it sorts: of an even number the upper one in the middle; NAN of none. */
double eval_median(double *values, size_t count);

/* Structural similarity (Wang et al. 2004) of two images of one size with values in [0, 1]: Gaussian window of 11 with
 * σ 1.5, C1 = 0.01², C2 = 0.03², windows wholly inside only, mean over windows per channel, then over channels. In
 * [-1, 1], 1 for equal images. Refuses unequal images and sides below 11. */
status eval_ssim(const img *a, const img *b, double *out);

#endif
