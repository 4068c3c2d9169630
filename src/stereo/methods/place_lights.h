/* SPDX-License-Identifier: MIT */
/* Lights whose places are listed about the object, as lists of domes have them: how far the camera is from it then
 * is not known, but the pictures tell, by how light falls off along the object and comes from elsewhere.
 *
 *     status s = pst_capture_read(folder, &options, &c);
 *     if (s == OK && c.about_object) s = pst_place_lights(&c, watch); */
#ifndef MERLIN_STEREO_METHODS_PLACE_LIGHTS_H
#define MERLIN_STEREO_METHODS_PLACE_LIGHTS_H

#include "stereo/capture/capture.h"

/* Makes positions about the object ones in the camera's space, and the lights near, at the capture's mean distance or,
 * where that is not known, at the one that explains the pictures best. Lights that are not asked to be near stay
 * distant where their directions explain the pictures nearly as well, and a line in `noticed` says which it is. Refuses
 * near ones where the pictures do not tell the distance. */
status pst_place_lights(merlin_capture *c, const watch *shown);

#endif
