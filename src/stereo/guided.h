/* SPDX-License-Identifier: MIT */
/* merlin_stereo (include/merlin/stereo.h) for those who bring a guide.
 *
 *     status s = pst_stereo_guided(capture, &params, &(pst_guide){.find = find, .context = network}, &surface);
 */
#ifndef MERLIN_STEREO_GUIDED_H
#define MERLIN_STEREO_GUIDED_H

#include "stereo/methods/guide.h"

/* Does what merlin_stereo does, with what the guide finds if the method is for near lights. guide NULL: without. */
status pst_stereo_guided(const merlin_capture *capture, const merlin_stereo_params *params, const pst_guide *guide,
                         merlin_surface *out);

#endif
