/* SPDX-License-Identifier: MIT */
/* merlin_estimate_object (merlin/estimate.h) for callers that also need the cues for the light. */
#ifndef MERLIN_ESTIMATE_PHOTO_ESTIMATE_H
#define MERLIN_ESTIMATE_PHOTO_ESTIMATE_H

#include "estimate/photo/light_cues.h"
#include "merlin/estimate.h"

/* Estimates as merlin_estimate_object does, and returns the cues from which the warning about the light is derived. */
status estimate_with_cues(merlin_model *model, merlin_image *photo, merlin_object *object, const merlin_params *params,
                          light_cues *cues, merlin_maps *maps);

#endif
