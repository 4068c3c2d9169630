/* SPDX-License-Identifier: MIT */
/* A problem of unknown lights with fewer, larger pixels: lights concern all pixels, so that large pictures tell no more
 * of them than small ones, and take longer.
 *
 *     smaller_problem small;
 *     status s = smaller_problem_new(p, &small);
 *     ... find the lights of small.problem ...
 *     smaller_problem_free(&small);
 */
#ifndef MERLIN_STEREO_UNCALIBRATED_SMALLER_PROBLEM_H
#define MERLIN_STEREO_UNCALIBRATED_SMALLER_PROBLEM_H

#include "stereo/fit/problem.h"

typedef struct smaller_problem {
    pst_problem problem;
    int factor; /* number of pixels that became one, along a side; 1: the problem is the one that was given */
    merlin_capture capture;
    pst_expected expected;
    img normal, depth;
} smaller_problem;

/* Makes it, with the lights of p, which is borrowed. Problems of an ordinary size stay as they are. MERLIN_NO_MEMORY;
 * call smaller_problem_free then, too. */
status smaller_problem_new(const pst_problem *p, smaller_problem *out);
void smaller_problem_free(smaller_problem *s);

#endif
