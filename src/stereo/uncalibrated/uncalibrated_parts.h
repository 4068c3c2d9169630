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

/* Surface and lights that were found together. */
typedef struct pst_near_found {
    merlin_light *light;  /* count */
    img depth;            /* consistent with the lights */
    img bent;             /* the expected normals, bent as the surface that was found; empty if nothing is expected */
    double cost_of_value; /* mean of the values' costs, in [0, 1] */
    bool uneven;          /* whether the lights are not equally strong */
} pst_near_found;
void pst_near_found_free(pst_near_found *f);

/* Finds positions of near lights of one power or, if that explains the pictures far better, of any
 * (uncalibrated_near.c). camera: with a perspective. out is freed by the caller even on failure. */
status pst_find_near_lights(const pst_problem *p, const pinhole *camera, pst_near_found *out);

/* The same for distant lights of something that is expected, seen by a camera from far away: they are far near ones. */
status pst_find_lights_afar(const pst_problem *p, const pinhole *camera, pst_near_found *out);

/* Solves fewer than PST_FEWEST_UNKNOWN pictures by what is expected (uncalibrated_few.c). p's capture has a
 * perspective; camera_known: it is the true one, so that lights are near, else it is far away, and they are distant. */
status pst_solve_few(const pst_problem *p, bool camera_known, merlin_surface *out);

#endif
