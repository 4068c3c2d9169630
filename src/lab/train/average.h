/* SPDX-License-Identifier: MIT */
/* An exponential moving average of the weights over the last steps, which is better than any single step's (Polyak &
 * Juditsky 1992). A run with "average_decay" validates and exports it.
 *
 *     train_average *a;
 *     train_average_new(params, 0.9995, &a);    begins at the values of params
 *     train_average_add(a, step, last);         after every step
 *     train_average_swap(a); ... use params ...; train_average_swap(a);
 */
#ifndef MERLIN_LAB_TRAIN_AVERAGE_H
#define MERLIN_LAB_TRAIN_AVERAGE_H

#include "nn/nn.h"

typedef struct train_average train_average;

/* Begins an average. decay: weight of the old mean at a step, from 0 to below 1. params must outlive it. */
status train_average_new(nn_params *params, double decay, train_average **out);
void train_average_free(train_average *a);
/* Updates the mean after step number `step` (from 1). At a run's start the decay is at most (1 + step) / (10 + step),
 * so that untrained weights are forgotten. Only some steps, and always the last, update the mean, with the weight of
 * those that were skipped. */
void train_average_add(train_average *a, int64_t step, bool last);
/* Exchanges the mean with the values of params, batch norm's statistics too: calling it twice changes nothing. */
void train_average_swap(train_average *a);
/* Returns the mean of parameter i, for checkpoints. */
float *train_average_values(train_average *a, size_t i);

#endif
