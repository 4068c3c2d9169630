/* SPDX-License-Identifier: MIT */
/* What all pixels of an object share (lobe_fit.h), found from a sample of them.
 *
 *     pst_lobe lobe;
 *     status s = pst_lobe_choose(&sample, &lobe);
 *
 * With few lights (below PST_MANY_LIGHTS) a lobe is allowed only if it foretells pictures that it was not fitted to
 * better than Lambert's law does; how far from the fit an observation may be is found in the same way.
 *
 * Each of these is what costs the sample least, and departs from the plain choice only where it earns its place:
 *
 * - the lobe's kind: GGX, or Beckmann's and Blinn's shorter tail, with more or less masking;
 * - the focal length, under distant lights: highlights move with the view, so they tell an orthographic picture from
 *   one with perspective;
 * - the cosine τ at which the surface turns dark. Lambert's law has τ = 0. Pictures whose black level was taken too
 *   high, and renderers that hide a mesh's facets at the shadow's edge by a bias (Blender's ray bias: (n·l − τ)/(1 −
 * τ)), have τ > 0; left out, it turns every normal by degrees. */
#ifndef MERLIN_STEREO_FIT_LOBE_CHOICE_H
#define MERLIN_STEREO_FIT_LOBE_CHOICE_H

#include "stereo/fit/field_fit.h"

/* Whether there is a lobe, and the width; the rest is the plain choice. */
status pst_lobe_admit(const pst_field *sample, pst_lobe *lobe);

/* sample: problem, pixel, count, depth and scale are read. */
status pst_lobe_choose(const pst_field *sample, pst_lobe *lobe);

/* The kind of lobe that a part of the sample has instead, as objects of several materials do; *worth: whether it saves
 * enough. With few lights never. */
status pst_lobe_choose_second(const pst_field *sample, const pst_lobe *lobe, pst_lobe *second, bool *worth);

#endif
