/* SPDX-License-Identifier: MIT */
/* What turns vectors into unit vectors, up to a rotation: the prior of uncalibrated photometric stereo, for lights of
 * one strength or a surface of one albedo (H. Hayakawa, JOSA A 11(11), 1994, his constraints 2 and 1).
 *
 *     unit_quadric q;
 *     status s = unit_quadric_fit(lights, count, &q);      |q.make v| = 1 for most v
 *     n = q.dual times b                                    b · v = n · (q.make v) */
#ifndef MERLIN_STEREO_ALGEBRA_UNIT_QUADRIC_H
#define MERLIN_STEREO_ALGEBRA_UNIT_QUADRIC_H

#include <stddef.h>

#include "base/status.h"
#include "base/vec.h"

typedef struct unit_quadric {
    double make[9], dual[9]; /* row-major; dual: the inverse's transpose */
    double spread;           /* of the lengths |make v| about 1: their median distance, six that fit anyhow left out */
} unit_quadric;

/* By least squares, reweighted for the vectors that are not like most. MERLIN_BAD_INPUT if there is no such ellipsoid.
 */
status unit_quadric_fit(const vec3 *v, size_t count, unit_quadric *out);

#endif
