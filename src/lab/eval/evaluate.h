/* A model measured on held-out samples, beside trivial answers.
 *
 *     eval_options options = {.data = "heldout", .weights = "weights.safetensors"};
 *     eval_report report;
 *     status s = eval_run(&options, &report);
 *     if (s == OK) eval_print_table(&report, stdout);
 *
 * What each row means is in docs/evaluation.md. Results depend on the samples, the weights and the number type alone.
 */
#ifndef MERLIN_LAB_EVAL_EVALUATE_H
#define MERLIN_LAB_EVAL_EVALUATE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "nn/nn.h"

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

enum { EVAL_MAX_CLASSES = 16, EVAL_SATURATIONS = 3 };
typedef struct eval_report {
    char model[64];
    int size;             /* of the samples, pixels a side */
    int views;            /* orientations of a picture whose mean the maps are */
    float white;          /* radiance at which the photographs saturate */
    int given;            /* set of EVAL_GIVEN_* */
    bool means_from_data; /* the mean maps are those of the evaluated samples themselves */
    size_t means_samples; /* how many samples the mean maps were taken over */
    eval_scores all;
    char class_names[EVAL_MAX_CLASSES][32]; /* the samples' shape classes, in order of appearance */
    eval_scores classes[EVAL_MAX_CLASSES];
    int class_count;
    eval_scores saturations[EVAL_SATURATIONS]; /* less than 10 % of a sample saturated, less than 40 %, more */
    double seconds;
} eval_report;

typedef struct eval_options {
    const char *data, *weights;
    const char *means;   /* file of eval_means_write; NULL: computed from the data itself */
    size_t count;        /* the first so many samples; 0: all */
    float white;         /* radiance at which the photograph saturates, from 1, the paper's, on; 0 counts as 1 */
    size_t environments; /* so many of them, from the first on, are relit by environments too */
    int given;           /* set of EVAL_GIVEN_*: the true maps take the place of the estimated ones */
    nn_type type;
    int views;          /* orientations of each picture whose mean the maps are, to 8; 0: as merlin estimate */
    const char *figure; /* PNG of predictions beside the truth; NULL: none */
    int figure_rows;    /* samples shown */
    bool quiet;
    int (*stopped)(void); /* polled between samples; NULL: never */
} eval_options;

status eval_run(const eval_options *options, eval_report *out);

#endif
