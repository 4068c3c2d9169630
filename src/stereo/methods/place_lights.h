/* SPDX-License-Identifier: MIT */
/* Lights whose positions are listed relative to the object, as for domes: the camera's distance is then unknown, but
 * can be estimated from the fall-off of light along the object and the change of its direction.
 *
 *     status s = pst_capture_read(folder, &options, &c);
 *     if (s == OK && c.about_object) s = pst_place_lights(&c, watch);
 */
#ifndef MERLIN_STEREO_METHODS_PLACE_LIGHTS_H
#define MERLIN_STEREO_METHODS_PLACE_LIGHTS_H

#include "stereo/capture/capture.h"

/* Converts positions relative to the object to the camera's space and makes the lights near, at the capture's mean
 * distance or, if unknown, at the one that explains the pictures best. Unless near lights were requested, they stay
 * distant if their directions explain the pictures nearly as well, and `noticed` gets a line with the choice. Fails for
 * near lights if the pictures do not determine the distance. */
status pst_place_lights(merlin_capture *c, const watch *shown);

#endif
