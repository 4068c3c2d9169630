/* SPDX-License-Identifier: MIT */
/* The mean of two weights files of one network, of which one was trained on from the other: it has most of what was
 * learned and little of what was lost (Wortsman et al. 2022, "Model soups"). */
#ifndef MERLIN_LAB_TRAIN_MEAN_WEIGHTS_H
#define MERLIN_LAB_TRAIN_MEAN_WEIGHTS_H

#include "base/status.h"

/* Writes (1 - share) first + share second to `output`, with the second's provenance and a note. MERLIN_BAD_INPUT if
 * they are of different networks. */
status train_mean_weights(const char *first, const char *second, double share, const char *output);

#endif
