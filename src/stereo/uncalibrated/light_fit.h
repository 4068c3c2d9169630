/* SPDX-License-Identifier: MIT */
/* The 3×3 matrix between a surface and its distant lights, which the pictures leave unknown, by three priors at once
 * (docs/notes/several_photographs.md): the lights are about equally strong, except for a few; the surface is
 * integrable; it is similar to an expected one. No prior is exact, so that all are robust. */
#ifndef MERLIN_STEREO_UNCALIBRATED_LIGHT_FIT_H
#define MERLIN_STEREO_UNCALIBRATED_LIGHT_FIT_H

#include "stereo/uncalibrated/integrable.h"

/* Finds m: m·b are the surface's normals times albedo, the transposed inverse of m times a light its direction times
 * strength. f->b: averaged over a neighbourhood; light: count of them, in its space. *uneven: whether the lights are
 * not equally strong, so that strengths were held against m the less. MERLIN_BAD_INPUT if the mask is too thin. */
status pst_fit_lights(const pst_pseudo *f, const vec3 *light, int count, double m[9], bool *uneven);

#endif
