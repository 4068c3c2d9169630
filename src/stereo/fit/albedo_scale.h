/* SPDX-License-Identifier: MIT */
/* The scale of an albedo that was found under lights of unknown power.
 *
 *     float scale;
 *     status s = pst_scale_albedo(&surface.albedo, &capture.mask, &scale);
 */
#ifndef MERLIN_STEREO_FIT_ALBEDO_SCALE_H
#define MERLIN_STEREO_FIT_ALBEDO_SCALE_H

#include "image/image.h"

/* Multiplies the albedo so that the 99th percentile of the object's values, all channels together, is 0.9, and clips it
 * to [0, 1]; what is not finite becomes 0. mask: 1 channel, above 0.5 on the object. *scale: the factor, 1 for an
 * albedo that is black. MERLIN_NO_MEMORY. */
status pst_scale_albedo(img *albedo, const img *mask, float *scale);

#endif
