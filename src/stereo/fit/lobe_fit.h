/* SPDX-License-Identifier: MIT */
/* One pixel's surface from its values under many lights: Lambert's law plus one specular lobe, with cast shadows,
 * indirect light and what the lobe does not explain as outliers.
 *
 *     pst_lobe_data data;
 *     pst_lobe_prepare(&observations, view, lobe.shadow, &data);
 *     pst_shading found = pst_lobe_fit(&data, &lobe);
 *
 * The model is in lobe.h. */
#ifndef MERLIN_STEREO_FIT_LOBE_FIT_H
#define MERLIN_STEREO_FIT_LOBE_FIT_H

#include "stereo/fit/lobe.h"

/* Returns an ordinary value of the pixel: the median of those above a hundredth of its brightest. */
float pst_ordinary_level(const pst_observations *o);

/* Prepares observations. view: unit vector to the camera; shadow: the cost of a shadow. */
void pst_lobe_prepare(const pst_observations *o, vec3 view, float shadow, pst_lobe_data *out);

/* Returns the best of several starts: Lambert's fit, and the normal that mirrors the brightest observations. */
pst_shading pst_lobe_fit(const pst_lobe_data *d, const pst_lobe *lobe);

/* Returns the best of the result so far and of starts all around, for a pixel whose cost is still high. */
pst_shading pst_lobe_search(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *so_far);

/* Returns the shading of another lobe that is most similar, as a start. */
pst_shading pst_lobe_translate(const pst_lobe *from, const pst_lobe *to, const pst_shading *at);

/* Returns the minimum near a start or, sooner, a result that costs more than the limit. */
pst_shading pst_lobe_refine(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *start, float limit);

/* Computes each observation's weight in the fit, in [0, 1], and its value by the fit. */
void pst_lobe_weigh(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *at, float *weight, float *model);

/* Returns the prediction error of cross-validation: fits to three quarters of the observations are compared with the
 * remaining quarter, and the residuals, each in [0, 1], summed, with shadows counting less. Unlike the loss it grows if
 * noise is fitted. */
float pst_lobe_predict(const pst_observations *o, vec3 view, const pst_lobe *lobe);

#endif
