/* SPDX-License-Identifier: MIT */
/* How likely a candidate for an object's place is right. */
#ifndef MERLIN_ESTIMATE_OBJECT_OBJECT_QUALITY_H
#define MERLIN_ESTIMATE_OBJECT_OBJECT_QUALITY_H

#include "estimate/object/object_candidate.h"

/* Share of the picture that an object has at least. */
#define OBJECT_LEAST_AREA 0.005f

/* Log odds that a candidate and the object have 0.97 of their union in common; -INFINITY for what is no object: nothing
 * or nearly all of the picture. */
float object_quality(const object_cues *c);

#endif
