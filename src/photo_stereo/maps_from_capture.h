/* SPDX-License-Identifier: MIT */
/* merlin_maps_from_capture (merlin/surface.h) for callers that also want what the network alone gives, maps or lights.
 */
#ifndef MERLIN_PHOTO_STEREO_MAPS_FROM_CAPTURE_H
#define MERLIN_PHOTO_STEREO_MAPS_FROM_CAPTURE_H

#include <stdbool.h>

#include "base/status.h"
#include "merlin/surface.h"

/* Makes maps of a capture's pictures; refined: by photometric stereo, as merlin_maps_from_capture does. */
status maps_of_capture(merlin_model *model, const merlin_capture *capture, const merlin_params *params, bool refined,
                       merlin_maps *maps);

/* Tells where the lights of a capture's pictures are by a network that compares them (merlin_model_add_several):
 * position of each of lights[0 .. count-1], in the unit of the camera's distance (1 if that is unknown); the rest of
 * them stays as it is. What is listed of the capture's lights is ignored. MERLIN_WRONG_USE for a model that compares no
 * pictures, and for more pictures than it sees. */
status lights_of_capture(merlin_model *model, const merlin_capture *capture, int (*stop)(void), merlin_light *lights);

#endif
