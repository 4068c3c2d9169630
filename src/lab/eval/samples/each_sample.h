/* SPDX-License-Identifier: MIT */
/* Goes through a folder's samples and shows how far it is.
 *
 *     const eval_samples all = {.folder = "heldout", .what = "evaluating"};
 *     status s = eval_each_sample(&all, measure_file, &run);
 */
#ifndef MERLIN_LAB_EVAL_SAMPLES_EACH_SAMPLE_H
#define MERLIN_LAB_EVAL_SAMPLES_EACH_SAMPLE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

typedef struct eval_samples {
    const char *folder, *what; /* what: is done to them, for the progress */
    size_t count;              /* the first so many; 0: all */
    bool quiet;
    int (*stopped)(void); /* asked between samples; NULL: never */
} eval_samples;

/* Calls a function for each, in the order of their names, until one fails. MERLIN_BAD_INPUT for a folder without
 * samples. */
status eval_each_sample(const eval_samples *of, status (*each)(void *context, const char *path), void *context);

#endif
