/* SPDX-License-Identifier: MIT */
/* A model measured on held-out samples, beside trivial answers: by merlin_estimate and merlin_relight, or the network
 * alone (raw.h).
 *
 *     eval_options options = {.data = "heldout", .weights = "weights.safetensors"};
 *     eval_report report;
 *     status s = eval_run(&options, &report);
 *     if (s == OK) eval_print_table(&report, stdout);
 *
 * What each row means is in docs/evaluation.md. Results depend on the samples, the weights and the number type alone.
 */
#ifndef MERLIN_LAB_EVAL_SAMPLES_EVALUATE_H
#define MERLIN_LAB_EVAL_SAMPLES_EVALUATE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "lab/eval/metrics/scores.h"
#include "nn/nn.h"

enum { EVAL_MAX_CLASSES = 16, EVAL_SATURATIONS = 3 };
typedef struct eval_report {
    char model[64];
    int size;             /* of the samples, pixels a side */
    bool raw;             /* the network alone was measured */
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
    const char *means; /* file of eval_means_write; NULL: computed from the data itself */
    size_t count;      /* the first so many samples; 0: all */
    bool raw;          /* the network alone */
    float white; /* radiance at which the photograph saturates, from 1, the paper's, on; 0: 1 of the network alone,
                  * else EXPOSURE_WHITE, a camera's */
    size_t environments; /* so many of them, from the first on, are relit by environments too */
    int given;           /* set of EVAL_GIVEN_*: the true maps take the place of the network's; with raw alone */
    nn_type type;        /* of the network alone; merlin_estimate computes in nn_fastest_type */
    int views;           /* orientations of each picture whose mean the maps are, to 8; 0: as merlin estimate */
    const char *figure;  /* PNG of predictions beside the truth; NULL: none */
    int figure_rows;     /* samples shown */
    bool quiet;
    int (*stopped)(void); /* polled between samples; NULL: never */
} eval_options;

status eval_run(const eval_options *options, eval_report *out);

#endif
