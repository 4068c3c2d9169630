/* SPDX-License-Identifier: MIT */
/* Normals seen by one camera, told to another. Internal to the evaluation of stereo.
 *
 * The network takes the crop around an object for the whole frame of its own camera, 60 degrees wide. What a picture
 * tells is the angle between the surface and the line of sight, so a normal keeps its place relative to the ray of its
 * pixel when that ray is the ray of another camera. */
#ifndef MERLIN_LAB_EVAL_METRICS_NORMAL_FRAME_H
#define MERLIN_LAB_EVAL_METRICS_NORMAL_FRAME_H

#include "stereo/capture/capture.h"

/* Turns each pixel's normal by the least rotation that takes the first camera's ray to the second's. Pixels without a
 * normal stay so. */
void normal_frame_change(img *normal, const pinhole *from, const pinhole *to);
#endif
