/* SPDX-License-Identifier: MIT */
/* Connected regions of a mask, and their convex hull. */
#ifndef MERLIN_ESTIMATE_OBJECT_OBJECT_REGIONS_H
#define MERLIN_ESTIMATE_OBJECT_OBJECT_REGIONS_H

#include <stdint.h>

#include "estimate/object/object_view.h"

/* Keeps the region with the largest weight, in which pixels near the picture's middle count more, and those with at
 * least a tenth of it; or, if some pixels are wanted (1 in `wanted`, which may be NULL), the regions that contain one.
 * Holes stay if they have a thousandth of the picture's pixels and `toward` on average classifies them as background.
 * Only MERLIN_NO_MEMORY is possible. */
status object_regions_keep(const object_view *v, const uint8_t *wanted, const int32_t *toward, uint8_t *object);

/* Sets hull to 1 in the object's convex hull, an intersection of half planes in a few directions, and to 0 elsewhere.
 */
void object_regions_hull(const object_view *v, const uint8_t *object, uint8_t *hull);

#endif
