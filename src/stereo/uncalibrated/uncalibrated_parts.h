/* SPDX-License-Identifier: MIT */
/* What method uncalibrated is made of: two ways to find the lights, and what they found. */
#ifndef MERLIN_STEREO_UNCALIBRATED_UNCALIBRATED_PARTS_H
#define MERLIN_STEREO_UNCALIBRATED_UNCALIBRATED_PARTS_H

#include "stereo/fit/problem.h"
#include "stereo/uncalibrated/integrable.h"

/* Directions and strengths of distant lights (uncalibrated_distant.c); light: count entries, from the problem's.
 * balloon: unit normals of one of the object's outline (inflate.h). rotation: the last step to them, and its doubts. */
status pst_find_distant_lights(const pst_problem *p, const img *balloon, merlin_light *light, pst_rotation *rotation);

/* Positions of near lights of one power, and a depth map that goes with them (uncalibrated_near.c). camera: with a
 * perspective. depth is made here. */
status pst_find_near_lights(const pst_problem *p, const pinhole *camera, merlin_light *light, img *depth);

#endif
