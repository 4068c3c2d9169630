/* SPDX-License-Identifier: MIT */
/* Paths of a run's files. */
#ifndef MERLIN_LAB_TRAIN_TRAIN_PATHS_H
#define MERLIN_LAB_TRAIN_TRAIN_PATHS_H

#include "base/status.h"
#include "lab/train/train_options.h"

typedef struct train_paths {
    char *checkpoint, *curves, *validation, *chart, *weights, *seconds;
} train_paths;

/* Composes them; the folder is made once data and model are accepted. MERLIN_WRONG_USE if a run or weights that are in
 * use would be replaced, MERLIN_BAD_INPUT if there is no run to resume, MERLIN_NO_MEMORY. Call train_paths_free
 * whatever it returns. */
status train_paths_new(const train_options *o, train_paths *out);
void train_paths_free(train_paths *p);

#endif
