/* SPDX-License-Identifier: MIT */
/* Trains a network: from a folder of samples to weights.
 *
 *     train_options o = {.config = "configs/runs/merlin-point/01-128.json", .data = "data/train", .output = "runs/1"};
 *     status s = train_run(&o);
 *
 * The output folder receives checkpoint.safetensors (every few minutes and when stopped), curves.csv, validation.csv
 * and curves.png, seconds.txt (time spent), and weights.safetensors, the best so far by validation loss (the latest,
 * without validation). A run that was killed and resumed ends with the same weights, checkpoint and curves, bit for
 * bit, as one that was not. */
#ifndef MERLIN_LAB_TRAIN_TRAIN_H
#define MERLIN_LAB_TRAIN_TRAIN_H

#include <stdbool.h>

#include "base/ranks/ranks.h"
#include "base/status.h"

typedef struct train_options {
    const char *config, *data, *output;
    const char *init; /* weights to start from, or NULL */
    /* Other models' weights, ended by NULL: tensors that fit by name and shape are taken, from the last file that has
     * them. */
    const char *const *init_shared;
    const char *note; /* stored in the weights' metadata, such as the commit; or NULL */
    bool resume;      /* continue from the output folder's checkpoint; without, such a folder is refused */
    bool quiet;
    int (*interrupted)(void); /* called after every step; NULL: never */
    ranks *together;          /* NULL, or processes that share every batch: only rank 0 writes */
} train_options;

/* Runs the training. Returns MERLIN_STOPPED after an interrupt, with everything saved. If ranks cannot begin, the first
 * of them returns the error, the others STATUS_ELSEWHERE. Later the others wait for one that has failed: ranks_abort
 * ends them. */
status train_run(const train_options *o);

#endif
