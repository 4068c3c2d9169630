/* SPDX-License-Identifier: MIT */
/* Searches candidates for the mask of a photograph's object, and chooses the one most likely to be correct.
 *
 *     object_search s;
 *     status result = object_search_run(&photo, NULL, &s);
 *     if (result == OK) result = object_outline(&s, &s.candidate[s.best], &photo, &mask);
 *     object_search_free(&s);
 *
 * The first guesses differ in the threshold of difference from the border's colours; the candidates grown from them
 * differ where the picture is ambiguous. */
#ifndef MERLIN_ESTIMATE_OBJECT_OBJECT_SEARCH_H
#define MERLIN_ESTIMATE_OBJECT_OBJECT_SEARCH_H

#include "estimate/object/object_candidate.h"
#include "merlin/merlin.h"

enum { OBJECT_MOST_CANDIDATES = 10 };

typedef struct object_search {
    float exposure; /* factor by which the photograph is multiplied */
    object_view view;
    img away;     /* distance of border_distance */
    float *prior; /* fields of object_ground, as are the next two */
    uint8_t *fixed, *wanted;
    uint8_t *ring;  /* 1 within the border's width, or outside the hint's box */
    uint8_t *start; /* first guess of the next candidate */
    object_candidate candidate[OBJECT_MOST_CANDIDATES];
    int count, best;
    int hinted; /* index of the first candidate that grew from a hint */
} object_search;

/* Runs the search. hint: sound, or NULL. MERLIN_BAD_INPUT if nothing differs from the border. */
status object_search_run(const img *photo, const merlin_hint *hint, object_search *out);
/* Grows one candidate, from where the object was in the picture before: 1 channel of the photograph's size. Its quality
 * lacks the agreement with others. */
status object_search_follow(const img *photo, const img *before, object_search *out);
void object_search_free(object_search *s);

/* Makes a candidate's mask in the photograph's size, with an outline that follows the photograph's edges: 1 channel in
 * [0, 1]. */
status object_outline(const object_search *s, const object_candidate *c, const img *photo, img *mask);

#endif
