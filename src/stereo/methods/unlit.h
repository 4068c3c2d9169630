/* SPDX-License-Identifier: MIT */
/* Fills in pixels that no light reaches: their values are noise, which would give a random normal, a spike in the mesh.
 * They continue their neighbours instead (docs/notes/real_captures.md).
 *
 *     status s = pst_unlit_fill(problem, &surface);
 */
#ifndef MERLIN_STEREO_METHODS_UNLIT_H
#define MERLIN_STEREO_METHODS_UNLIT_H

#include "stereo/fit/problem.h"
#include "stereo/integrate/stereo_surface.h"

/* Replaces the normals of pixels that are dark in every picture by the smoothest continuation of those around them
 * (harmonic, component by component); a region without lit pixels around it faces the camera. */
status pst_unlit_fill(const pst_problem *p, merlin_surface *s);

#endif
