/* SPDX-License-Identifier: MIT */
/* One pixel's surface from its values under many lights: Lambert's law plus one specular lobe, with cast shadows, light
 * from elsewhere and what the lobe does not explain as outliers.
 *
 *     pst_lobe_data data;
 *     pst_lobe_prepare(&observations, view, lobe.shadow, &data);
 *     pst_shading found = pst_lobe_fit(&data, &lobe);
 *
 * lobe.h has the model. */
#ifndef MERLIN_STEREO_FIT_LOBE_FIT_H
#define MERLIN_STEREO_FIT_LOBE_FIT_H

#include "stereo/fit/lobe.h"

/* A value that is ordinary for the pixel: the median of those above a hundredth of its brightest. */
float pst_ordinary_level(const pst_observations *o);

/* view: unit, to the camera; shadow: what a shadow costs. */
void pst_lobe_prepare(const pst_observations *o, vec3 view, float shadow, pst_lobe_data *out);

/* The best of several starts: Lambert's fit, and the normal that the brightest observations mirror. */
pst_shading pst_lobe_fit(const pst_lobe_data *d, const pst_lobe *lobe);

/* The best of what was found and of starts all around, for a pixel that they did not serve. */
pst_shading pst_lobe_search(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *so_far);

/* The start of another lobe that looks most like a shading of the one. */
pst_shading pst_lobe_translate(const pst_lobe *from, const pst_lobe *to, const pst_shading *at);

/* The best near a start, or something that costs more than the limit, which is found sooner. */
pst_shading pst_lobe_refine(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *start, float limit);

/* weight gets each observation's share in the fit, in [0, 1], model what the fit makes of it. */
void pst_lobe_weigh(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *at, float *weight, float *model);

/* How far the fits to three quarters of the observations are from the quarter that each was not shown: the sum of the
 * residuals, each in [0, 1], shadows cheaper. Unlike the loss it grows with what is fitted to noise. */
float pst_lobe_foretell(const pst_observations *o, vec3 view, const pst_lobe *lobe);

#endif
