/* SPDX-License-Identifier: MIT */
/* Properties that all pixels of an object share (lobe_fit.h), found from a sample of them.
 *
 *     pst_lobe lobe;
 *     status s = pst_lobe_choose(&sample, &lobe);
 *
 * With few lights (below PST_MANY_LIGHTS) a lobe is allowed only if it predicts pictures that were held out of the fit
 * better than Lambert's law does; the tolerance of residuals is found in the same way.
 *
 * Each of these has the value of least cost for the sample, and differs from the plain choice only if that gains
 * enough:
 *
 * - the lobe's kind: GGX, or the shorter tails of Beckmann and Blinn, with more or less masking;
 * - the focal length, under distant lights: highlights move with the view, and so distinguish an orthographic picture
 *   from one with perspective;
 * - the cosine τ at which the surface turns dark. Lambert's law has τ = 0. Pictures whose black level was chosen too
 *   high, and renderers that hide a mesh's facets at the shadow's edge by a bias (Blender's ray bias: (n·l − τ)/(1 −
 *   τ)), have τ > 0; ignored, it turns every normal by degrees.
 */
#ifndef MERLIN_STEREO_FIT_LOBE_CHOICE_H
#define MERLIN_STEREO_FIT_LOBE_CHOICE_H

#include "stereo/fit/field_fit.h"

/* Chooses whether there is a lobe, and the width; the rest is the plain choice. */
status pst_lobe_admit(const pst_field *sample, pst_lobe *lobe);

/* Chooses everything. sample: problem, pixel, count, depth and scale are read. */
status pst_lobe_choose(const pst_field *sample, pst_lobe *lobe);

/* Chooses the lobe of another material for a part of the sample; *worth: whether it saves enough, never with few
 * lights. */
status pst_lobe_choose_second(const pst_field *sample, const pst_lobe *lobe, pst_lobe *second, bool *worth);

#endif
