/* SPDX-License-Identifier: MIT */
/* Scales of spherical harmonics inside the network, by band: for model_encode_sh, its inverse, and the graph. */
#ifndef MERLIN_MODEL_SH_BANDS_H
#define MERLIN_MODEL_SH_BANDS_H

/* Factors from radiance in bands 0, 1 and 2 to the light of a diffuse white surface, divided by the root of the
 * sphere's area: then the mean over all normals of the squared light is the sum of the squared code. */
static const float sh_scale[3] = {0.28209479f, 0.18806319f, 0.07052370f};
enum { SH_BANDS = 3 };
static const int sh_first[SH_BANDS] = {0, 3, 12}, sh_count[SH_BANDS] = {3, 9, 15};

#endif
