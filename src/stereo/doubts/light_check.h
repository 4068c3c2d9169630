/* SPDX-License-Identifier: MIT */
/* Tells whether a list of lights can be that of the pictures. The residual alone does not tell: with y listed downward
 * it is the same, and of gloss and shadows it is large.
 *
 *     warnings doubts = {0};
 *     status s = pst_check_lights(&capture, &surface, &doubts);      adds lights_do_not_fit, and what would fit */
#ifndef MERLIN_STEREO_DOUBTS_LIGHT_CHECK_H
#define MERLIN_STEREO_DOUBTS_LIGHT_CHECK_H

#include "base/warnings.h"
#include "stereo/integrate/stereo_surface.h"

/* Checks a solved capture whose lights are known. */
status pst_check_lights(const merlin_capture *c, const merlin_surface *s, warnings *out);

#endif
