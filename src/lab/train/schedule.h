/* SPDX-License-Identifier: MIT */
/* Which sample comes when, and how fast the network learns then. Both depend on the presentation's number alone, so
 * that a resumed run goes on as if it had never stopped. */
#ifndef MERLIN_LAB_TRAIN_SCHEDULE_H
#define MERLIN_LAB_TRAIN_SCHEDULE_H

#include <stdint.h>

#include "lab/train/train_config.h"

/* Every epoch is a permutation of 0 .. count-1 of its own. */
typedef struct train_order {
    uint64_t seed;
    size_t count;
    uint64_t epoch; /* that `index` holds; UINT64_MAX: none yet */
    uint32_t *index;
} train_order;

status train_order_new(train_order *o, uint64_t seed, size_t count);
void train_order_free(train_order *o);
/* The sample of presentation p. */
size_t train_order_at(train_order *o, uint64_t p);

/* Of the step that begins at this presentation: rises over the first warmup_steps, halves every halve_every_epochs. */
double train_learning_rate(const train_config *c, size_t epoch, uint64_t presentation);

#endif
