/* SPDX-License-Identifier: MIT */
/* One candidate for an object's mask: grown from a first guess in a few rounds of "learn the colours of both sides, cut
 * at the least cost, keep the main regions" (GrabCut, Rother et al. 2004), with cues for and against it. */
#ifndef MERLIN_ESTIMATE_OBJECT_OBJECT_CANDIDATE_H
#define MERLIN_ESTIMATE_OBJECT_OBJECT_CANDIDATE_H

#include <stdbool.h>

#include "estimate/object/object_view.h"

/* Integer cost of the cuts per unit of log odds. */
#define OBJECT_UNIT 100.0f

/* Cues of a candidate. All shares are in [0, 1]. */
typedef struct object_cues {
    float edge;               /* mean contrast of colours along the outline: 1 - tie */
    float weak;               /* share of the outline with hardly any contrast */
    float apart;              /* mean certainty with which colours classify pixels correctly */
    float unsure;             /* share of pixels whose colours are undecided or contradict the candidate */
    float top, sides, bottom; /* shares of the picture's border that are object */
    float area;               /* area as a share of the picture */
    float solid;              /* area divided by that of the convex hull */
    float compact;            /* 4π area divided by the squared outline */
    float centre;             /* distance of its middle from the picture's, in units of half its diagonal */
    float away;               /* mean border distance inside */
    float near;               /* mean border distance outside */
    float plain;              /* fit of the mixture to the background's colours, in nats per pixel */
    float dark;               /* how much darker the background is */
    float agree, most_agree;  /* mean and largest intersection over union with other candidates */
} object_cues;

typedef struct object_candidate {
    uint8_t *object; /* mask, 0 or 1 */
    mixture inside, outside;
    object_cues cues;
    float quality; /* log odds of being correct */
} object_candidate;

/* Data that all candidates of a picture share. */
typedef struct object_ground {
    const object_view *view;
    const float *prior;    /* log odds of being object, by place */
    const float *away;     /* distance from the border, for object_cues */
    const uint8_t *fixed;  /* 0: free; else 1 + side */
    const uint8_t *wanted; /* pixels wanted by the hint, for object_regions_keep, or NULL */
    grid_cut cut;          /* grid with its ties set */
    float tie;             /* strength of ties between similar neighbours */
} object_ground;

/* Grows a candidate from a first guess and computes its cues, except for the agreement with other candidates. start: 0
 * or 1; both sides should have some pixels. */
status object_candidate_grow(object_ground *ground, const uint8_t *start, bool outside_hull, object_candidate *out);
void object_candidate_free(object_candidate *c);

/* Returns the intersection over union of two masks. */
float object_overlap(const uint8_t *one, const uint8_t *other, size_t count);
/* Computes the classification by colours: above 0 for object, in units of the cut's ties. */
void object_toward(const object_candidate *c, const mixture_pixels *pixels, float *cost, int32_t *toward);

#endif
