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

#include "base/status.h"
#include "lab/train/train_options.h"

/* Runs the training. Returns MERLIN_STOPPED after an interrupt, with everything saved. If ranks cannot begin, the first
 * of them returns the error, the others STATUS_ELSEWHERE. Later the others wait for one that has failed: ranks_abort
 * ends them. */
status train_run(const train_options *o);

#endif
