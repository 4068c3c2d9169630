/* SPDX-License-Identifier: MIT */
/* How far a pixel's normal depends on single pictures.
 *
 *     float weight[PST_MAX_LIGHTS], model[PST_MAX_LIGHTS];
 *     pst_lobe_weigh(&data, &lobe, &shading, weight, model);
 *     float degrees = pst_normal_spread(&data.seen, weight, model, shading.normal, shading.albedo);
 */
#ifndef MERLIN_STEREO_FIT_NORMAL_SPREAD_H
#define MERLIN_STEREO_FIT_NORMAL_SPREAD_H

#include "stereo/fit/pixel_fit.h"

/* The spread of a pixel that too few pictures light, in degrees: its normal may be any. */
#define PST_ANY_NORMAL 90.0f

/* Returns the jackknife's standard error of the normal (Efron, The jackknife, the bootstrap and other resampling plans,
 * 1982, chapter 3), in degrees: from its turns when each lit picture in turn is left out of the weighted least squares,
 * which have a closed form. weight, model: each observation's weight, 0 for those in shadow, and its value by the fit;
 * n: unit. */
float pst_normal_spread(const pst_observations *o, const float *weight, const float *model, vec3 n, float albedo);

#endif
