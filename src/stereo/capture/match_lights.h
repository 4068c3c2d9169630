/* SPDX-License-Identifier: MIT */
/* Assigns the lights of a list to pictures: by name, by number, or by their order.
 *
 *     status s = pst_match_lights(folder, options, "dome.lp", &list, &capture);   fills its names, a light each
 */
#ifndef MERLIN_STEREO_CAPTURE_MATCH_LIGHTS_H
#define MERLIN_STEREO_CAPTURE_MATCH_LIGHTS_H

#include "base/lights/light_list.h"
#include "stereo/capture/capture.h"

/* Allocates the capture and sets the name of each light's picture. Names match in any case, with another ending or
 * without one, if exactly one picture matches. Numbers count the pictures in their order. A dome's list is made once,
 * with the names of other pictures, and used for every object: if none of its names exists, its lights belong to the
 * folder's pictures in order, if the names have one. Fails for names that do not exist or occur twice; notes pictures
 * without a light in the capture's `noticed`. Lists without names are in the pictures' order. */
status pst_match_lights(const char *folder, const merlin_capture_files *options, const char *lights,
                        const light_list *list, merlin_capture *c);

/* Returns the folder's file or picture of that name, by the rules of pst_match_lights, malloc'ed; *found is NULL if
 * there is not exactly one. */
status pst_match_name(const char *folder, const char *name, char **found);

#endif
