/* SPDX-License-Identifier: MIT */
/* Checks whether something stated or assumed about a capture, other than its lights' order and axes, explains the
 * pictures clearly worse than another value: a lens, a distance, a tone curve, equal strengths.
 *
 *     status s = pst_check_model(&capture, &surface, &doubts);
 */
#ifndef MERLIN_STEREO_DOUBTS_MODEL_CHECK_H
#define MERLIN_STEREO_DOUBTS_MODEL_CHECK_H

#include "base/warnings.h"
#include "stereo/integrate/stereo_surface.h"

/* Adds other_distance, other_lens, other_tones and strengths_unequal, if they apply, with the value that fits better,
 * found by solving a small version of the pictures again for each. */
status pst_check_model(const merlin_capture *c, const merlin_surface *s, warnings *out);

/* Computes the median residual of a surface, as outlines and cast shadows, which no model here includes, leave much in
 * few pixels; infinite without pixels. */
status pst_typical_residual(const merlin_capture *c, const merlin_surface *s, double *out);

/* Adds strengths_unequal: as what fits better is strengths other than the list's. */
void pst_warn_strengths(warnings *out);

#endif
