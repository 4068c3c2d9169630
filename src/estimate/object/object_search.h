/* SPDX-License-Identifier: MIT */
/* Candidates for where a photograph's object is, and the one that is most likely right.
 *
 *     object_search s;
 *     status result = object_search_run(&photo, NULL, &s);
 *     if (result == OK) result = object_outline(&s, &s.candidate[s.best], &photo, &mask);
 *     object_search_free(&s);
 *
 * The first guesses differ in how far from the border's colours an object begins; what grows from them differs where it
 * is not sure. */
#ifndef MERLIN_ESTIMATE_OBJECT_OBJECT_SEARCH_H
#define MERLIN_ESTIMATE_OBJECT_OBJECT_SEARCH_H

#include "estimate/object/object_candidate.h"
#include "merlin/merlin.h"

enum { OBJECT_MOST_CANDIDATES = 10 };

typedef struct object_search {
    float exposure; /* what the photograph is multiplied by */
    object_view view;
    img away;     /* border_distance's */
    float *prior; /* object_ground's, as the next two are */
    uint8_t *fixed, *wanted;
    uint8_t *ring;  /* 1 within the border's width, or outside the hint's box */
    uint8_t *start; /* the next candidate's first guess */
    object_candidate candidate[OBJECT_MOST_CANDIDATES];
    int count, best;
    int hinted; /* candidates from this one on grew from a hint */
} object_search;

/* hint: sound, or NULL. MERLIN_BAD_INPUT if nothing stands out from the border at all. */
status object_search_run(const img *photo, const merlin_hint *hint, object_search *out);
void object_search_free(object_search *s);

/* A candidate's mask in the photograph's size, its outline where the photograph's edges are: 1 channel in [0, 1]. */
status object_outline(const object_search *s, const object_candidate *c, const img *photo, img *mask);

#endif
