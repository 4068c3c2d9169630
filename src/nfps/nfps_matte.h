/* SPDX-License-Identifier: MIT */
/* A pixel's normal as that of a matte surface, from its values alone: what the network of near lights (model/nfps.h)
 * need not find by itself. */
#ifndef MERLIN_NFPS_NFPS_MATTE_H
#define MERLIN_NFPS_NFPS_MATTE_H

#include "nfps/nfps_scene.h"

/* Fills in NFPS_MATTE values a pixel, zero outside the mask: the normal, turned, unit and toward the eye, of the robust
 * fit of Lambert's law (stereo/fit/pixel_fit.h); the fit's cost a picture, in [0, 1]; and how far the normal depends on
 * single pictures (stereo/fit/normal_spread.h), as e / (e + 10 degrees). Fewer than three lights leave the normal among
 * their directions. images: as for nfps_encode; strength: of each picture's light at each pixel;
 * light: NFPS_LIGHT values, the turned direction first. At most NN_LARGEST_GROUP pictures. */
void nfps_matte(const nfps_scene *scene, const float *images, const float *strength, const float *light, float *matte);

#endif
