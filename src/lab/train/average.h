/* SPDX-License-Identifier: MIT */
/* The mean of the weights over the last steps, which is better than any one of them (Polyak & Juditsky 1992): an
 * exponential moving average. It is what a run with "average_decay" validates and exports.
 *
 *     trn_average *a;
 *     trn_average_new(params, 0.9995, &a);    begins at the values params has
 *     trn_average_add(a, step, last);         after every step
 *     trn_average_swap(a); ... use params ...; trn_average_swap(a);
 */
#ifndef MERLIN_LAB_TRAIN_AVERAGE_H
#define MERLIN_LAB_TRAIN_AVERAGE_H

#include "nn/nn.h"

typedef struct trn_average trn_average;

/* decay: the share of the old mean that a step keeps, from 0 to below 1. params must outlive it. */
status trn_average_new(nn_params *params, double decay, trn_average **out);
void trn_average_free(trn_average *a);
/* After step number `step` (from 1). The mean over a run's start is shorter, so that it forgets untrained weights: the
 * share kept is at most (1 + step) / (10 + step). Most steps are passed over and made up for by the next that is not;
 * the run's last is not. */
void trn_average_add(trn_average *a, int64_t step, bool last);
/* Exchanges the mean with the values of params, batch norm's statistics too: called twice it changes nothing. */
void trn_average_swap(trn_average *a);
/* The mean of parameter i, to be kept in a checkpoint. */
float *trn_average_values(trn_average *a, size_t i);

#endif
