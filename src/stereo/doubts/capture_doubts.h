/* SPDX-License-Identifier: MIT */
/* Warnings about a capture and the surface found from it: reasons not to trust the result.
 *
 *     warnings doubts = {0};
 *     status s = pst_doubts(&capture, &surface, &doubts);
 */
#ifndef MERLIN_STEREO_DOUBTS_CAPTURE_DOUBTS_H
#define MERLIN_STEREO_DOUBTS_CAPTURE_DOUBTS_H

#include "base/warnings.h"
#include "stereo/integrate/stereo_surface.h"

/* Adds lights_do_not_fit, other_distance, other_lens, other_tones, strengths_unequal, mask_inverted, lights_behind,
 * lights_alike, lights_behind_camera, other_unit, same_pictures, burnt_out, lights_in_order, strengths_unsure,
 * distance_unsure and lights_unsure, if they apply. */
status pst_doubts(const merlin_capture *c, const merlin_surface *s, warnings *out);
/* Adds what tells against the pictures, their mask and their files whatever is made of them: same_pictures,
 * mask_inverted, reduced_size, first_frame and what the reader noticed. */
status pst_doubt_pictures(const merlin_capture *c, warnings *out);
/* Adds only same_pictures, if it applies. */
status pst_check_copies(const merlin_capture *c, warnings *out);

#endif
