/* A capture of any size brought to a small square around its object. Internal to the evaluation of stereo. */
#ifndef MERLIN_EVAL_STEREO_FRAME_H
#define MERLIN_EVAL_STEREO_FRAME_H

#include "stereo/capture.h"

/* Cuts and shrinks pictures, mask, truth and camera in place, and photo (3 channels of the capture's size, or NULL)
 * with them. A pixel of the result belongs to the object if all it is made of does (stereo/shrink.h). */
status stereo_frame(pst_capture *c, img *photo, int most_side);

#endif
