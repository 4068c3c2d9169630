/* SPDX-License-Identifier: MIT */
/* Parts of the method uncalibrated: two ways to find the lights, and their results. */
#ifndef MERLIN_STEREO_UNCALIBRATED_UNCALIBRATED_PARTS_H
#define MERLIN_STEREO_UNCALIBRATED_UNCALIBRATED_PARTS_H

#include "stereo/fit/problem.h"
#include "stereo/uncalibrated/integrable.h"

/* Finds directions and strengths of distant lights (uncalibrated_distant.c); light: count entries, from the problem's.
 * inflated: unit normals of the object's inflated outline (inflate.h). rotation: the last step, and whether it is
 * unsure. */
status pst_find_distant_lights(const pst_problem *p, const img *inflated, merlin_light *light, pst_rotation *rotation);

/* The expected normals, bent as the surface that was found, and the cost of each value, with the priors' share. */
typedef struct pst_near_bend {
    img normal;
    double cost_of_value;
} pst_near_bend;

/* Finds positions of near lights of one power, and a depth map consistent with them (uncalibrated_near.c). camera: with
 * a perspective. depth is made here, and what bend (may be NULL, else zeros) has. */
status pst_find_near_lights(const pst_problem *p, const pinhole *camera, merlin_light *light, img *depth,
                            pst_near_bend *bend);

/* The same for distant lights, seen by a camera from far away: they are far near ones. equal: they are of one strength,
 * else their distances stand for their strengths. */
status pst_find_lights_afar(const pst_problem *p, const pinhole *camera, bool equal, merlin_light *light, img *depth,
                            pst_near_bend *bend);

/* Solves fewer than PST_FEWEST_UNKNOWN pictures by what is expected (uncalibrated_few.c). p's capture has a
 * perspective; camera_known: it is the true one, so that lights are near, else it is far away, and they are distant. */
status pst_solve_few(const pst_problem *p, bool camera_known, merlin_surface *out);

#endif
