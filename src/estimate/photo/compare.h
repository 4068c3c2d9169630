/* SPDX-License-Identifier: MIT */
/* Photographs of an object compared by a network that sees them together, at its own small size.
 *
 *     const photo_group of = {photos, count, &mask, &how, views, stop};
 *     status s = compare_photographs(n, &of, lights, &maps);
 */
#ifndef MERLIN_ESTIMATE_PHOTO_COMPARE_H
#define MERLIN_ESTIMATE_PHOTO_COMPARE_H

#include "estimate/photo/network.h"

/* Photographs as network_estimate_several takes them. */
typedef struct photo_group {
    const img *photos;
    int count;
    const img *mask;
    const sight *how;
    int views;
    int (*stop)(void);
} photo_group;

/* Estimates the lights of several photographs, up to NN_LARGEST_GROUP, and changes maps of the object (may be NULL),
 * which are finished, to have the coarse part of the network's own (coarse.h), if it makes some. MERLIN_WRONG_USE
 * unless it sees several. */
status compare_photographs(network *n, const photo_group *of, float (*lights)[MODEL_LIGHTS], surface *maps);

#endif
