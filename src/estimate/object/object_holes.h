/* SPDX-License-Identifier: MIT */
/* Finds holes that a first guess includes because the object surrounds them: parts that have exactly the colours of the
 * background next to the object. */
#ifndef MERLIN_ESTIMATE_OBJECT_OBJECT_HOLES_H
#define MERLIN_ESTIMATE_OBJECT_OBJECT_HOLES_H

#include <stdbool.h>

#include "estimate/object/object_view.h"

/* Sets hole to 1 in connected parts of at least a hundredth of the picture whose pixels are similar to the background
 * to the left or right, above or below, unless that is so dark that everything black is similar; 0 elsewhere. *any
 * tells whether there are some. Only MERLIN_NO_MEMORY is possible. */
status object_holes_find(const object_view *v, const uint8_t *object, uint8_t *hole, bool *any);

#endif
