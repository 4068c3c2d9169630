/* SPDX-License-Identifier: MIT */
/* The scale of an albedo found under lights of unknown power.
 *
 *     float scale;
 *     status s = pst_scale_albedo(&surface.albedo, &capture.mask, &scale);
 */
#ifndef MERLIN_STEREO_FIT_ALBEDO_SCALE_H
#define MERLIN_STEREO_FIT_ALBEDO_SCALE_H

#include "image/image.h"

/* Scales the albedo so that the 99th percentile of the object's values, over all channels, is 0.9, and clips it to [0,
 * 1]; values that are not finite become 0. mask: 1 channel, above 0.5 on the object. *scale: the factor, 1 for a black
 * albedo. MERLIN_NO_MEMORY. */
status pst_scale_albedo(img *albedo, const img *mask, float *scale);

#endif
