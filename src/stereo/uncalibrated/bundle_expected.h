/* SPDX-License-Identifier: MIT */
/* What is expected of a bundle's surface and lights (pst_expected).
 *
 *     status s = bundle_new(p, &camera, 12, &b);
 *     if (s == OK) s = bundle_expect(&b);
 *     if (s == OK && b.expected) bundle_take_expected(&b); */
#ifndef MERLIN_STEREO_UNCALIBRATED_BUNDLE_EXPECTED_H
#define MERLIN_STEREO_UNCALIBRATED_BUNDLE_EXPECTED_H

#include "stereo/uncalibrated/bundle.h"

/* Computes what is expected from the problem's (bundle_expected.c); does nothing if it has none, or no depth. */
status bundle_expect(bundle *b);
/* Sets the surface and the lights that are expected. */
void bundle_take_expected(bundle *b);
/* Makes the expected normals, moved by what the cells' normals differ from their mean in each cell, so that they keep
 * detail which no cell has. */
status bundle_bend_normals(const bundle *b, img *out);

#endif
