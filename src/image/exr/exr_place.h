/* SPDX-License-Identifier: MIT */
/* Values that were read from an EXR file, put where its display window has them.
 *
 *     s = exr_read(f, targets, n);
 *     const exr_frame seen = exr_display(f);
 *     if (s == OK) s = exr_place(&seen, &image);
 */
#ifndef MERLIN_IMAGE_EXR_EXR_PLACE_H
#define MERLIN_IMAGE_EXR_EXR_PLACE_H

#include "image/exr/exr.h"
#include "image/image.h"

/* Gives the image the frame's size: the values that lie in it, and zero around them. The frame's sides must be those of
 * an image; after a failure the image is as it was. */
status exr_place(const exr_frame *frame, img *image);

#endif
