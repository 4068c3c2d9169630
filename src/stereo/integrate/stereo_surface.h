/* SPDX-License-Identifier: MIT */
/* What is done with a surface that photometric stereo has found, and the names of the methods. */
#ifndef MERLIN_STEREO_INTEGRATE_STEREO_SURFACE_H
#define MERLIN_STEREO_INTEGRATE_STEREO_SURFACE_H

#include "stereo/capture/capture.h"

/* Finds a method by the name that people type ("ls", "robust", "near", "semi", "uncalibrated", "auto"); -1 if unknown.
 */
int pst_method_from_name(const char *name);
const char *pst_method_name(merlin_stereo_method m);

/* Integrates the normals into depth (integrate.h), unless the method has found it; params->integrate: even then, held
 * near what it found. */
status pst_surface_integrate(const merlin_stereo_params *params, merlin_surface *s);

#endif
