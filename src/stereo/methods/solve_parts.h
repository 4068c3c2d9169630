/* SPDX-License-Identifier: MIT */
/* The solvers of solve.h: each gets a checked problem and fills an allocated surface. */
#ifndef MERLIN_STEREO_METHODS_SOLVE_PARTS_H
#define MERLIN_STEREO_METHODS_SOLVE_PARTS_H

#include "stereo/fit/problem.h"
#include "stereo/integrate/stereo_surface.h"

/* Lists a capture's lights as a method needs them. light: as many as pictures. MERLIN_BAD_INPUT for intensities that no
 * light has. */
status pst_list_lights(const merlin_capture *c, merlin_stereo_method method, merlin_light *light);

status pst_solve_ls(const pst_problem *p, merlin_surface *out);
status pst_solve_robust(const pst_problem *p, merlin_surface *out);
status pst_solve_near(const pst_problem *p, merlin_surface *out);
/* Finds the distance at which the expected depth, or without one a plane, explains the pictures best, near `about`,
 * which is the depth's mean; 0: anywhere. */
status pst_near_distance(const pst_problem *p, float about, float *distance);
status pst_solve_semi(const pst_problem *p, merlin_surface *out);
status pst_solve_uncalibrated(const pst_problem *p, merlin_surface *out);
/* Takes normals and depth as they are expected, under near lights, and measures the albedo. */
status pst_solve_given(const pst_problem *p, merlin_surface *out);

#endif
