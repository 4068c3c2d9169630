/* SPDX-License-Identifier: MIT */
/* Results of the pixels around one of a field, as further starts of its fit. Internal to field_fit.c.
 *
 *     pst_around a = {.field = f, .slot = pst_field_slots(f)};
 *     const pst_shading *start[4];
 *     int starts = pst_better_neighbours(&a, i, start);
 *
 *     pst_majority m;
 *     if (pst_majority_against(&a, i, &m)) ... try m.member ...
 */
#ifndef MERLIN_STEREO_FIT_FIELD_NEIGHBOURS_H
#define MERLIN_STEREO_FIT_FIELD_NEIGHBOURS_H

#include "stereo/fit/field.h"

typedef struct pst_around {
    const pst_field *field;
    const int32_t *slot; /* indices from pst_field_slots */
    const bool *news;    /* per pixel: whether its shading is new to the neighbours; NULL: all are */
} pst_around;

/* Lists those of the four neighbours that are new, differ from the pixel and from each other, and cost less; returns
 * their number. */
int pst_better_neighbours(const pst_around *a, size_t i, const pst_shading *found[4]);

/* A majority: most of the eight neighbours agree with each other. */
typedef struct pst_majority {
    vec3 normal[8]; /* normals of all existing neighbours */
    int count;
    const pst_shading *member; /* the neighbour that differs least from the others */
} pst_majority;

/* Returns the difference of a normal from the neighbours': 0 if equal, 1 if it differs by 20 degrees or more from each.
 */
float pst_strangeness(const pst_majority *m, vec3 normal);

/* Tells whether there is a majority, and the pixel differs much more from it than its member. */
bool pst_majority_against(const pst_around *a, size_t i, pst_majority *m);

#endif
