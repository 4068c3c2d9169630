/* SPDX-License-Identifier: MIT */
/* Captures of pictures in memory: the camera of docs/conventions.md, point lights of the training data's power.
 *
 *     merlin_capture c;
 *     status s = near_capture_new(&mask, &depth, 60, &c);
 *     merlin_light light = {.position = {0.3f, 0, 0}};
 *     if (s == OK) s = near_capture_add(&c, &picture, &light);     picture in units of NEAR_CAPTURE_WHITE
 *     pst_capture_free(&c);
 */
#ifndef MERLIN_PHOTO_STEREO_NEAR_CAPTURE_H
#define MERLIN_PHOTO_STEREO_NEAR_CAPTURE_H

#include "stereo/capture/capture.h"

/* Radiance that becomes full scale: a white surface that faces a light at half the usual distance is not clipped. */
#define NEAR_CAPTURE_WHITE 8.0f

/* Makes a capture without pictures. mask: 1 channel, square, made 0 or 1 here; depth: 1 channel, whose mean over the
 * mask becomes the camera's distance; field_of_view: horizontal, degrees. Call pst_capture_free after a failure, too.
 */
status near_capture_new(const img *mask, const img *depth, float field_of_view, merlin_capture *out);
/* Adds a picture: 3 channels, radiance / NEAR_CAPTURE_WHITE, clipped to [0, 1]; light: its position and, of an LED,
 * direction and lobe. Its intensity is not read: it is that of the training data's power. MERLIN_NO_MEMORY and
 * MERLIN_BAD_INPUT as pst_capture_add. */
status near_capture_add(merlin_capture *c, const img *picture, const merlin_light *light);

#endif
