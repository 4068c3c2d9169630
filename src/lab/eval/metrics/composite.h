/* SPDX-License-Identifier: MIT */
/* Photographs whose mask is known: a rendered sample's object before a background that the project makes itself.
 *
 *     composite c;
 *     status s = composite_make(&sample, seed, COMPOSITE_FLOOR, &c);
 *     ... c.photo, c.mask ...
 *     composite_free(&c);
 *
 * The flash lights object and background alike, so that what is farther away is darker; some rooms have light of their
 * own. The object keeps its size or is shown smaller, off the middle, and now and then it is cut off below. Equal
 * (sample, seed, kind) give equal pictures. */
#ifndef MERLIN_LAB_EVAL_METRICS_COMPOSITE_H
#define MERLIN_LAB_EVAL_METRICS_COMPOSITE_H

#include "lab/render/sample.h"

typedef enum composite_kind {
    COMPOSITE_DARK,  /* nothing near enough for the flash to reach */
    COMPOSITE_WALL,  /* a plain wall with the flash's falloff and a shadow beside the object */
    COMPOSITE_FLOOR, /* on a floor of one colour, with its end or a wall behind */
    COMPOSITE_DESK,  /* on a textured desk before a wall */
    COMPOSITE_ROOM,  /* on a floor or before a wall, with things at the picture's border, out of focus or not */
    COMPOSITE_KINDS
} composite_kind;

/* Returns the kind's name, one word. */
const char *composite_name(composite_kind kind);

typedef struct composite {
    img photo; /* 3 channels, linear, in [0, 1] by steps of 8 bits in sRGB */
    img mask;  /* 1 channel, coverage */
} composite;

status composite_make(const sample *s, uint64_t seed, composite_kind kind, composite *out);
void composite_free(composite *c);

#endif
