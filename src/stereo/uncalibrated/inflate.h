/* SPDX-License-Identifier: MIT */
/* A surface from an outline alone: the shape of a balloon with that outline.
 *
 *     img normal, height;
 *     status s = pst_inflate(&mask, &normal, &height);
 */
#ifndef MERLIN_STEREO_UNCALIBRATED_INFLATE_H
#define MERLIN_STEREO_UNCALIBRATED_INFLATE_H

#include "base/status.h"
#include "image/image.h"

/* Inflates the mask (1 channel, above 0.5 on the object) to 3 channels of unit normals and 1 of heights toward the
 * camera in pixels: the height is √u with ∇²u = -4 inside the mask and u = 0 outside, which over a disc is exactly the
 * hemisphere. */
status pst_inflate(const img *mask, img *normal, img *height);

#endif
