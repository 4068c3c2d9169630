/* SPDX-License-Identifier: MIT */
/* Figures of a model and of trivial answers, summed over samples: a row of the tables each. */
#ifndef MERLIN_LAB_EVAL_METRICS_SCORES_H
#define MERLIN_LAB_EVAL_METRICS_SCORES_H

#include <stddef.h>

#include "base/status.h"
#include "image/image.h"

/* Errors are small when good, similarities (from EVAL_RECONSTRUCTION on) large. */
typedef enum eval_row {
    EVAL_ALBEDO,         /* mean squared error in [-1, 1] */
    EVAL_NORMAL,         /* mean squared error of unit vectors' components */
    EVAL_ANGLE,          /* mean angle between normals, degrees */
    EVAL_DEPTH,          /* mean squared error in scene units */
    EVAL_ROUGHNESS,      /* mean squared error in [-1, 1] */
    EVAL_SURROUNDINGS,   /* setting B: mean squared error of the radiance of white surfaces over all normals */
    EVAL_RECONSTRUCTION, /* direct + indirect against the input */
    EVAL_RELIT_NETWORK,  /* the relighting decoder against the true maps rendered under the target light */
    EVAL_RELIT_BRDF,     /* the estimated maps rendered, against the same */
    EVAL_BOTH_NETWORK,   /* setting B: the same two under the light in other surroundings */
    EVAL_BOTH_BRDF,
    EVAL_TRACED_NETWORK, /* with the network's indirect light, against path-traced pictures with cast shadows */
    EVAL_TRACED_BRDF,
    EVAL_TRACED_SHADOWS,      /* the maps' own cast shadows added */
    EVAL_ENVIRONMENT_BRDF,    /* the maps under an environment that the model was not shown, against the same */
    EVAL_ENVIRONMENT_SHADOWS, /* with the shadows that they cast on themselves, and a bounce */
    EVAL_ROWS
} eval_row;

typedef enum eval_answer {
    EVAL_MODEL,
    EVAL_MEAN,      /* the data set's mean maps */
    EVAL_INFLATED,  /* maps inflated from the mask */
    EVAL_UNCHANGED, /* the input itself, as a relit picture */
    EVAL_TRUE_MAPS, /* no trivial answer: the true maps rendered, with the true indirect light */
    EVAL_ANSWERS
} eval_answer;

/* Sets of maps: bits in this order. What each is worth to relighting is in docs/notes/relighting_limits.md. */
enum { EVAL_GIVEN_ALBEDO = 1, EVAL_GIVEN_NORMAL = 2, EVAL_GIVEN_ROUGHNESS = 4, EVAL_GIVEN_DEPTH = 8 };

/* What the photograph shows of a pixel: a value at its limit, or by the share of the flash's light there that is gloss,
 * less than 3 %, 10 %, 30 %, and more. */
enum { EVAL_BURNT_OUT, EVAL_MATTE, EVAL_REGIONS = 5 };
typedef struct eval_region {
    size_t pixels;
    double sum[EVAL_ROUGHNESS + 1][EVAL_INFLATED + 1]; /* squared errors of the maps (none of EVAL_ANGLE), by pixel */
} eval_region;

/* Each sample (and each relit picture of it) counts alike, in a region each pixel. */
typedef struct eval_scores {
    double sum[EVAL_ROWS][EVAL_ANSWERS];
    size_t count[EVAL_ROWS][EVAL_ANSWERS];
    size_t samples;
    double saturated; /* sum over samples: share of the object's values that the photograph shows at its limit */
    eval_region regions[EVAL_REGIONS];
} eval_scores;

/* The mean; NAN where there is none. */
double eval_score(const eval_scores *scores, eval_row row, eval_answer answer);
/* The better of the trivial answers; NAN where there is none. */
double eval_best_trivial(const eval_scores *scores, eval_row row);
/* The mean over a region's pixels; NAN where there is none. */
double eval_region_error(const eval_region *region, eval_row map, eval_answer answer);

void eval_note(eval_scores *scores, eval_row row, eval_answer answer, double value);
status eval_note_similarity(eval_scores *scores, eval_row row, eval_answer answer, const img *image, const img *target);
/* The trivial answers know nothing of what sets the rows apart. */
void eval_repeat_trivial(eval_scores *scores, eval_row from, eval_row to);

#endif
