/* SPDX-License-Identifier: MIT */
/* Finds holes that a first guess takes for object because the object surrounds them: parts of it that have the very
 * colours of the background beside the object. */
#ifndef MERLIN_ESTIMATE_OBJECT_OBJECT_HOLES_H
#define MERLIN_ESTIMATE_OBJECT_OBJECT_HOLES_H

#include <stdbool.h>

#include "estimate/object/object_view.h"

/* Sets hole to 1 in connected parts of at least a hundredth of the picture whose pixels are like the background to the
 * left or right, above or below, unless that is so dark that anything black is like it; 0 elsewhere. *any: there are
 * some. MERLIN_NO_MEMORY alone. */
status object_holes_find(const object_view *v, const uint8_t *object, uint8_t *hole, bool *any);

#endif
