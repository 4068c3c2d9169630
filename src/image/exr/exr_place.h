/* SPDX-License-Identifier: MIT */
/* Places values read from an EXR file where its display window has them.
 *
 *     s = exr_read(f, targets, n);
 *     const exr_frame seen = exr_display(f);
 *     if (s == OK) s = exr_place(&seen, &image);
 */
#ifndef MERLIN_IMAGE_EXR_EXR_PLACE_H
#define MERLIN_IMAGE_EXR_EXR_PLACE_H

#include "image/exr/exr.h"
#include "image/image.h"

/* Crops and pads the image to the frame's size: stored values inside it, and zeros around them. The frame's size must
 * be valid for an image; after a failure the image is unchanged. */
status exr_place(const exr_frame *frame, img *image);

#endif
