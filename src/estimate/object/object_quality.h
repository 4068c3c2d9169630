/* SPDX-License-Identifier: MIT */
/* Estimates the probability that a candidate for an object's mask is correct. */
#ifndef MERLIN_ESTIMATE_OBJECT_OBJECT_QUALITY_H
#define MERLIN_ESTIMATE_OBJECT_OBJECT_QUALITY_H

#include "estimate/object/object_candidate.h"

/* Least share of the picture that an object has. */
#define OBJECT_LEAST_AREA 0.005f

/* Returns the log odds that a candidate and the object have 0.97 of their union in common; -INFINITY for a candidate
 * that is nothing or nearly all of the picture. */
float object_quality(const object_cues *c);

#endif
