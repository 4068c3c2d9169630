/* SPDX-License-Identifier: MIT */
/* What the pixels around one of a field have found, for a further try of its own fit. Internal to field_fit.c.
 *
 *     pst_around a = {.field = f, .slot = pst_field_slots(f)};
 *     const pst_shading *start[4];
 *     int starts = pst_better_neighbours(&a, i, start);
 *
 *     pst_majority m;
 *     if (pst_majority_against(&a, i, &m)) ... try m.member ... */
#ifndef MERLIN_STEREO_FIT_FIELD_NEIGHBOURS_H
#define MERLIN_STEREO_FIT_FIELD_NEIGHBOURS_H

#include "stereo/fit/field.h"

typedef struct pst_around {
    const pst_field *field;
    const int32_t *slot; /* pst_field_slots */
    const bool *news;    /* a pixel: whether the neighbours have yet to see its shading; NULL: all */
} pst_around;

/* Of the four: those with news that differ from the pixel and from each other and cost less; returns how many. */
int pst_better_neighbours(const pst_around *a, size_t i, const pst_shading *found[4]);

/* Most of the eight agree with each other. */
typedef struct pst_majority {
    vec3 normal[8]; /* of all that there are */
    int count;
    const pst_shading *member; /* the one that is least strange to the others */
} pst_majority;

/* How far a normal is from the neighbours': 0 as theirs, 1 if it differs by 20 degrees or more from each. */
float pst_strangeness(const pst_majority *m, vec3 normal);

/* Whether there is such a majority and the pixel much stranger to it than its member. */
bool pst_majority_against(const pst_around *a, size_t i, pst_majority *m);

#endif
