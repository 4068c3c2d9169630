/* SPDX-License-Identifier: MIT */
/* The solvers of solve.h: each gets a checked problem and fills an allocated surface. */
#ifndef MERLIN_STEREO_METHODS_SOLVE_PARTS_H
#define MERLIN_STEREO_METHODS_SOLVE_PARTS_H

#include "stereo/fit/problem.h"
#include "stereo/integrate/stereo_surface.h"

status pst_solve_ls(const pst_problem *p, merlin_surface *out);
status pst_solve_robust(const pst_problem *p, merlin_surface *out);
status pst_solve_near(const pst_problem *p, merlin_surface *out);
status pst_solve_semi(const pst_problem *p, merlin_surface *out);
status pst_solve_uncalibrated(const pst_problem *p, merlin_surface *out);

#endif
