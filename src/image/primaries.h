/* SPDX-License-Identifier: MIT */
/* Linear colours of any primaries as those of this project, linear sRGB.
 *
 *     double m[9];
 *     if (primaries_to_srgb(xy, m)) srgb = m × colour; */
#ifndef MERLIN_IMAGE_PRIMARIES_H
#define MERLIN_IMAGE_PRIMARIES_H

#include <stdbool.h>

/* xy: CIE 1931 chromaticities of red, green, blue and white (SMPTE RP 177). m: rows one after the other; white stays
 * white, by the Bradford adaptation of ICC profiles. False where the primaries span no colours. */
bool primaries_to_srgb(const float xy[8], double m[9]);

/* sRGB's own, as far as files tell them apart. */
bool primaries_are_srgb(const float xy[8]);

/* The inverse of a matrix of such rows; false where there is none. */
bool primaries_invert(const double m[9], double out[9]);

#endif
