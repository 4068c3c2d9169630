/* SPDX-License-Identifier: MIT */
/* Connected parts of what was found, and its outer shape. */
#ifndef MERLIN_ESTIMATE_OBJECT_OBJECT_REGIONS_H
#define MERLIN_ESTIMATE_OBJECT_OBJECT_REGIONS_H

#include <stdint.h>

#include "estimate/object/object_view.h"

/* Keeps the region that is heaviest, pixels toward the picture's middle counting more, and those at least a tenth as
 * heavy; or, if some pixels are wanted (1 in `wanted`, which may be NULL), the regions that hold one. Holes stay if
 * they have a thousandth of the picture's pixels and `toward` says of them, on average, that they are background.
 * MERLIN_NO_MEMORY alone. */
status object_regions_keep(const object_view *v, const uint8_t *wanted, const int32_t *toward, uint8_t *object);

/* Sets hull to 1 in the object's convex hull, by half planes of some directions, and to 0 elsewhere. */
void object_regions_hull(const object_view *v, const uint8_t *object, uint8_t *hull);

#endif
