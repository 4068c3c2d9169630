/* SPDX-License-Identifier: MIT */
/* One answer to where an object is: grown from a first guess in a few rounds of "learn the colours of both sides, cut
 * at the least cost, keep the main regions" (GrabCut, Rother et al. 2004), and what speaks for it and against it. */
#ifndef MERLIN_ESTIMATE_OBJECT_OBJECT_CANDIDATE_H
#define MERLIN_ESTIMATE_OBJECT_OBJECT_CANDIDATE_H

#include <stdbool.h>

#include "estimate/object/object_view.h"

/* One log odds of the cuts' whole numbers. */
#define OBJECT_UNIT 100.0f

/* All shares are in [0, 1]. */
typedef struct object_cues {
    float edge;               /* how much colours change along the outline: mean of 1 - tie */
    float weak;               /* share of the outline where they hardly do */
    float apart;              /* mean of how decidedly the colours say what a pixel is, and say so rightly */
    float unsure;             /* share of the pixels where they do not, or say the contrary */
    float top, sides, bottom; /* shares of the picture's border that are object */
    float area;               /* share of the picture */
    float solid;              /* area by that of the convex hull */
    float compact;            /* 4π area by the squared outline */
    float centre;             /* distance of its middle from the picture's, in parts of half its diagonal */
    float away;               /* border distance inside, */
    float near;               /* and outside */
    float plain;              /* how well the background's colours are described, in nats a pixel */
    float dark;               /* how much darker the background is */
    float agree, most_agree;  /* mean and largest intersection over union with other candidates */
} object_cues;

typedef struct object_candidate {
    uint8_t *object; /* 0 or 1 */
    mixture inside, outside;
    object_cues cues;
    float quality; /* log odds of being right */
} object_candidate;

/* What all candidates of a picture share. */
typedef struct object_ground {
    const object_view *view;
    const float *prior;    /* log odds of being object, by place */
    const float *away;     /* distance from the border, object_cues' */
    const uint8_t *fixed;  /* 0: free; else 1 + side */
    const uint8_t *wanted; /* object_regions_keep's, or NULL */
    grid_cut cut;          /* tied */
    float tie;             /* what ties like neighbours */
} object_ground;

/* start: 0 or 1; both sides should have some. The cues are found but for how candidates agree. */
status object_candidate_grow(object_ground *ground, const uint8_t *start, bool outside_hull, object_candidate *out);
void object_candidate_free(object_candidate *c);

/* Share of the pixels of either that are both's. */
float object_overlap(const uint8_t *one, const uint8_t *other, size_t count);
/* What colours say: above 0 for object, in units of the cut's ties. */
void object_toward(const object_candidate *c, const mixture_pixels *pixels, float *cost, int32_t *toward);

#endif
