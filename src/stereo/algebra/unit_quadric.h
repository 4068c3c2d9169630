/* SPDX-License-Identifier: MIT */
/* The transform that makes vectors unit vectors, up to a rotation: the constraint of uncalibrated photometric stereo
 * for lights of one intensity or a surface of one albedo (H. Hayakawa, JOSA A 11(11), 1994, constraints 2 and 1).
 *
 *     unit_quadric q;
 *     status s = unit_quadric_fit(lights, count, &q);      |q.make v| = 1 for most v
 *     n = q.dual times b                                   b · v = n · (q.make v)
 */
#ifndef MERLIN_STEREO_ALGEBRA_UNIT_QUADRIC_H
#define MERLIN_STEREO_ALGEBRA_UNIT_QUADRIC_H

#include <stddef.h>

#include "base/status.h"
#include "base/vec.h"

typedef struct unit_quadric {
    double make[9], dual[9]; /* row-major; dual: transpose of the inverse */
    double spread; /* deviation of the lengths |make v| from 1: the median, without six vectors that any quadric fits */
} unit_quadric;

/* Fits the transform by least squares, reweighted against outliers. MERLIN_BAD_INPUT if there is no such ellipsoid. */
status unit_quadric_fit(const vec3 *v, size_t count, unit_quadric *out);

#endif
