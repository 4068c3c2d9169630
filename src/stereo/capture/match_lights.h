/* SPDX-License-Identifier: MIT */
/* Which picture a list's light belongs to: by name, by number, or by their order.
 *
 *     status s = pst_match_lights(folder, "dome.lp", &list, &capture);      fills the capture's names, a light each */
#ifndef MERLIN_STEREO_CAPTURE_MATCH_LIGHTS_H
#define MERLIN_STEREO_CAPTURE_MATCH_LIGHTS_H

#include "base/lights/light_list.h"
#include "stereo/capture/capture.h"

/* Reserves the capture and names the picture of each light. Names match in any case, with another ending or without
 * one, if that leaves one picture. Numbers count the pictures in their order. A dome's list is made once, with the
 * names of the pictures of then, and is used for every object: where none of its names is there, its lights are the
 * folder's pictures' in their order, if the names have one. Refuses names that are not there or twice; notes pictures
 * without a light in the capture's `noticed`. Lists without names are in the pictures' order. */
status pst_match_lights(const char *folder, const char *lights, const light_list *list, merlin_capture *c);

/* The folder's file or picture of that name, as pst_match_lights finds it, malloc'ed; *found is NULL if there is not
 * exactly one. */
status pst_match_name(const char *folder, const char *name, char **found);

#endif
