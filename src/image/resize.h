/* SPDX-License-Identifier: MIT */
/* Sizes, crops and filters. */
#ifndef MERLIN_IMAGE_RESIZE_H
#define MERLIN_IMAGE_RESIZE_H

#include "image/image.h"

/* Lanczos when enlarging, area-correct when shrinking. */
status img_resize(const img *from, int width, int height, img *out);
/* To the size of `cover` (1 channel) and in its rows' spans (img_row_span) alone; zero beside them. */
status img_resize_covered(const img *from, const img *cover, img *out);
/* img_resize of image times mask (1 channel, the image's size), without that product as a whole. */
status img_resize_masked(const img *from, const img *mask, int width, int height, img *out);
/* The rectangle at (x, y), which may hang over the edges: what lies outside is zero. */
status img_crop(const img *from, int x, int y, int width, int height, img *out);
/* Sums over windows of (2 radius + 1)² pixels, in time that does not depend on the radius; outside the image is zero.
 */
status img_box_sums(img *image, int radius);
/* Guided filter upsampling (He et al. 2013; fast form, He & Sun 2015): low-resolution maps brought to the guide's size
 * so that their edges follow it. guide: 1 or 3 channels. low_mask (1 channel, low's size, or NULL) and mask (1 channel,
 * guide's size, or NULL) keep what is outside from leaking in; what lies outside mask becomes zero. radius in
 * low-resolution pixels; epsilon in squared guide units. */
status img_guided_upsample(const img *low, const img *low_mask, const img *guide, const img *mask, int radius,
                           float epsilon, img *out);

#endif
