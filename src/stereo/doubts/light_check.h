/* SPDX-License-Identifier: MIT */
/* Checks whether a list of lights can belong to the pictures. The residual alone does not suffice: it is the same with
 * y listed downward, and large with gloss and shadows.
 *
 *     warnings doubts = {0};
 *     status s = pst_check_lights(&capture, &surface, &doubts);      adds lights_do_not_fit, and what would fit
 */
#ifndef MERLIN_STEREO_DOUBTS_LIGHT_CHECK_H
#define MERLIN_STEREO_DOUBTS_LIGHT_CHECK_H

#include "base/warnings.h"
#include "stereo/integrate/stereo_surface.h"

/* Checks a solved capture whose lights are known. */
status pst_check_lights(const merlin_capture *c, const merlin_surface *s, warnings *out);

#endif
