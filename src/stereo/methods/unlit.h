/* SPDX-License-Identifier: MIT */
/* Pixels that no light reaches: they show noise, and a fit to it is a normal at random, a spike in the mesh. They go on
 * from their neighbours instead (docs/notes/real_captures.md).
 *
 *     status s = pst_unlit_fill(problem, &surface); */
#ifndef MERLIN_STEREO_METHODS_UNLIT_H
#define MERLIN_STEREO_METHODS_UNLIT_H

#include "stereo/fit/problem.h"
#include "stereo/integrate/stereo_surface.h"

/* Makes the normals of pixels that are dark in every picture the smoothest that join those around them (harmonic,
 * component by component); what has no lit pixel around it faces the camera. */
status pst_unlit_fill(const pst_problem *p, merlin_surface *s);

#endif
