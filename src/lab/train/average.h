/* SPDX-License-Identifier: MIT */
/* The mean of the weights over the last steps, which is better than any one of them (Polyak & Juditsky 1992): an
 * exponential moving average. It is what a run with "average_decay" validates and exports.
 *
 *     train_average *a;
 *     train_average_new(params, 0.9995, &a);    begins at the values params has
 *     train_average_add(a, step, last);         after every step
 *     train_average_swap(a); ... use params ...; train_average_swap(a);
 */
#ifndef MERLIN_LAB_TRAIN_AVERAGE_H
#define MERLIN_LAB_TRAIN_AVERAGE_H

#include "nn/nn.h"

typedef struct train_average train_average;

/* decay: the share of the old mean that a step keeps, from 0 to below 1. params must outlive it. */
status train_average_new(nn_params *params, double decay, train_average **out);
void train_average_free(train_average *a);
/* After step number `step` (from 1). The mean over a run's start is shorter, so that it forgets untrained weights: the
 * share kept is at most (1 + step) / (10 + step). Most steps are passed over and made up for by the next that is not;
 * the run's last is not. */
void train_average_add(train_average *a, int64_t step, bool last);
/* Exchanges the mean with the values of params, batch norm's statistics too: called twice it changes nothing. */
void train_average_swap(train_average *a);
/* The mean of parameter i, to be kept in a checkpoint. */
float *train_average_values(train_average *a, size_t i);

#endif
