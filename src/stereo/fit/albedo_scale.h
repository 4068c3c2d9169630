/* SPDX-License-Identifier: MIT */
/* The scale of an albedo found under lights of unknown power.
 *
 *     float scale;
 *     status s = pst_scale_albedo(&surface.albedo, &capture.mask, &scale);
 */
#ifndef MERLIN_STEREO_FIT_ALBEDO_SCALE_H
#define MERLIN_STEREO_FIT_ALBEDO_SCALE_H

#include "image/image.h"

/* Finds the factor by which the 99th percentile of the object's values, over all channels, becomes 0.9; 1 for a black
 * albedo. mask: 1 channel, above 0.5 on the object. MERLIN_NO_MEMORY. */
status pst_albedo_scale(const img *albedo, const img *mask, float *scale);
/* Scales the albedo by this factor and clips it to [0, 1]; values that are not finite become 0. MERLIN_NO_MEMORY. */
status pst_scale_albedo(img *albedo, const img *mask, float *scale);

#endif
