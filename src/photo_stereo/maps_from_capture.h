/* SPDX-License-Identifier: MIT */
/* merlin_maps_from_capture (merlin/surface.h) for callers that also want what the network alone gives. */
#ifndef MERLIN_PHOTO_STEREO_MAPS_FROM_CAPTURE_H
#define MERLIN_PHOTO_STEREO_MAPS_FROM_CAPTURE_H

#include <stdbool.h>

#include "base/status.h"
#include "merlin/surface.h"

/* Makes maps of a capture's pictures; refined: by photometric stereo, as merlin_maps_from_capture does. */
status maps_of_capture(merlin_model *model, const merlin_capture *capture, const merlin_params *params, bool refined,
                       merlin_maps *maps);

#endif
