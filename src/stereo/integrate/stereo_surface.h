/* SPDX-License-Identifier: MIT */
/* Integration of a surface found by photometric stereo, and the names of the methods. */
#ifndef MERLIN_STEREO_INTEGRATE_STEREO_SURFACE_H
#define MERLIN_STEREO_INTEGRATE_STEREO_SURFACE_H

#include "stereo/capture/capture.h"

/* Returns the method of this name ("ls", "robust", "near", "semi", "uncalibrated", "nfps", "auto"); -1 if unknown. */
int pst_method_from_name(const char *name);

/* Returns MERLIN_WRONG_USE unless the surface has all of its images, of one size. */
status pst_surface_check(const merlin_surface *s);

/* Integrates the normals to depth (integrate.h) unless the method has found depth; with params->integrate even then,
 * close to what it found. */
status pst_surface_integrate(const merlin_stereo_params *params, merlin_surface *s);

#endif
