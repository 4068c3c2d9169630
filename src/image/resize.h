/* SPDX-License-Identifier: MIT */
/* Resizing, crops and filters. */
#ifndef MERLIN_IMAGE_RESIZE_H
#define MERLIN_IMAGE_RESIZE_H

#include "image/image.h"

/* Resizes by Lanczos when enlarging, by area when shrinking. */
status img_resize(const img *from, int width, int height, img *out);
/* Resizes to the size of `cover` (1 channel), computing only its rows' spans (img_row_span); zero outside them. */
status img_resize_covered(const img *from, const img *cover, img *out);
/* Resizes image times mask (1 channel, the image's size) as img_resize does, without storing that product. */
status img_resize_masked(const img *from, const img *mask, int width, int height, img *out);
/* Copies the rectangle at (x, y), which may extend over the edges; outside the image it is zero. */
status img_crop(const img *from, int x, int y, int width, int height, img *out);
/* Replaces each pixel by the sum over a window of (2 radius + 1)² pixels, in time independent of the radius; outside
 * the image is zero. */
status img_box_sums(img *image, int radius);
/* Enlarges low-resolution maps to the guide's size so that their edges follow it, by guided filter upsampling (He et
 * al. 2013; fast form, He & Sun 2015). guide: 1 or 3 channels. low_mask (1 channel, low's size, or NULL) and mask (1
 * channel, guide's size, or NULL) keep what is outside from leaking in; outside mask the result is zero. radius in
 * low-resolution pixels; epsilon in squared guide units. */
status img_guided_upsample(const img *low, const img *low_mask, const img *guide, const img *mask, int radius,
                           float epsilon, img *out);

#endif
