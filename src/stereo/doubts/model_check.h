/* SPDX-License-Identifier: MIT */
/* Tells whether something that was told or assumed of a capture, other than its lights' order and axes, explains the
 * pictures clearly worse than another value would: a lens, a distance, a tone curve, equal strengths.
 *
 *     status s = pst_check_model(&capture, &surface, &doubts); */
#ifndef MERLIN_STEREO_DOUBTS_MODEL_CHECK_H
#define MERLIN_STEREO_DOUBTS_MODEL_CHECK_H

#include "base/warnings.h"
#include "stereo/integrate/stereo_surface.h"

/* Adds other_distance, other_lens, other_tones and strengths_unequal, where they hold, naming what fits better: found
 * by solving a small version of the pictures again under each. */
status pst_check_model(const merlin_capture *c, const merlin_surface *s, warnings *out);

#endif
