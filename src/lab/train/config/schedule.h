/* SPDX-License-Identifier: MIT */
/* Order of the samples and schedule of the learning rate. Both depend on the presentation's number alone, so that a
 * resumed run continues as if it had not been stopped. */
#ifndef MERLIN_LAB_TRAIN_CONFIG_SCHEDULE_H
#define MERLIN_LAB_TRAIN_CONFIG_SCHEDULE_H

#include <stdint.h>

#include "lab/train/config/train_config.h"

/* The order of samples: every epoch has its own permutation of 0 .. count-1. */
typedef struct train_order {
    uint64_t seed;
    size_t count;
    uint64_t epoch; /* epoch whose permutation is in `index`; UINT64_MAX: none yet */
    uint32_t *index;
} train_order;

status train_order_new(train_order *o, uint64_t seed, size_t count);
void train_order_free(train_order *o);
/* Returns the sample of presentation p. */
size_t train_order_at(train_order *o, uint64_t p);

/* Returns the rate of the step that begins at this presentation: it rises over the first warmup_steps and halves every
 * halve_every_epochs. */
double train_learning_rate(const train_config *c, size_t epoch, uint64_t presentation);

#endif
