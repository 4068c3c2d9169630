/* SPDX-License-Identifier: MIT */
/* A problem with fewer, larger pixels, on which slow searches start: large pictures tell no more of lights and coarse
 * shape than small ones, and take longer.
 *
 *     smaller_problem small;
 *     status s = smaller_problem_new(p, 1500, &small);
 *     ... find lights or depth of small.problem ...
 *     smaller_problem_free(&small);
 */
#ifndef MERLIN_STEREO_FIT_SMALLER_PROBLEM_H
#define MERLIN_STEREO_FIT_SMALLER_PROBLEM_H

#include "stereo/fit/problem.h"

typedef struct smaller_problem {
    pst_problem problem;
    int factor; /* number of pixels that became one, along a side; 1: the problem is the one that was given */
    merlin_capture capture;
    pst_expected expected;
    img normal, depth;
} smaller_problem;

/* Makes it of this number of the object's pixels, or at most four times as many, with the lights of p, which is
 * borrowed; a problem that has no more stays as it is. MERLIN_NO_MEMORY; call smaller_problem_free then, too. */
status smaller_problem_new(const pst_problem *p, int pixels, smaller_problem *out);
void smaller_problem_free(smaller_problem *s);

#endif
