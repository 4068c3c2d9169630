/* SPDX-License-Identifier: MIT */
/* A capture of any size brought to a small square around its object. Internal to the evaluation of stereo. */
#ifndef MERLIN_LAB_EVAL_STEREO_STEREO_FRAME_H
#define MERLIN_LAB_EVAL_STEREO_STEREO_FRAME_H

#include "merlin/merlin.h"
#include "stereo/capture/capture.h"

/* Cuts and shrinks pictures, mask, truth and camera in place, and photo (3 channels of the capture's size, or NULL)
 * with them. A pixel of the result belongs to the object if all it is made of does (stereo/capture/shrink.h). */
status stereo_frame(merlin_capture *c, img *photo, int most_side);

/* Refuses maps of such a capture whose crop is not all of it: normals are compared pixel by pixel. An object of thin
 * parts may lose them where it is shrunk, and a closer square is what merlin_estimate takes then. */
status stereo_frame_check(const merlin_capture *c, const merlin_maps *maps);

#endif
