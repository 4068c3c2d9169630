/* SPDX-License-Identifier: MIT */
/* Conversion of linear colours of any primaries to linear sRGB.
 *
 *     double m[9];
 *     if (primaries_to_srgb(xy, m)) srgb = m × colour;
 */
#ifndef MERLIN_IMAGE_PRIMARIES_H
#define MERLIN_IMAGE_PRIMARIES_H

#include <stdbool.h>

/* Computes the matrix m, row by row. xy: CIE 1931 chromaticities of red, green, blue and white (SMPTE RP 177). White
 * stays white, by the Bradford adaptation of ICC profiles. Returns false if the primaries are degenerate. */
bool primaries_to_srgb(const float xy[8], double m[9]);

/* Tells whether the chromaticities are sRGB's, to the precision of files. */
bool primaries_are_srgb(const float xy[8]);

/* Inverts such a matrix; returns false if it is singular. */
bool primaries_invert(const double m[9], double out[9]);

#endif
