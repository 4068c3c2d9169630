/* SPDX-License-Identifier: MIT */
#include "lab/train/config/schedule.h"

#include <math.h>
#include <stdlib.h>

#include "base/rng.h"
#include "lab/train/config/streams.h"

status train_order_new(train_order *o, uint64_t seed, size_t count)
{
    *o = (train_order){.seed = seed, .count = count, .epoch = UINT64_MAX, .index = malloc(count * sizeof *o->index)};
    return o->index ? OK : fail(MERLIN_NO_MEMORY, "out of memory for the order of %zu samples", count);
}

void train_order_free(train_order *o)
{
    free(o->index);
    *o = (train_order){0};
}

/* Shuffles by Fisher and Yates. */
static void shuffle(train_order *o, uint64_t epoch)
{
    rng r = rng_at(o->seed, epoch, TRAIN_STREAM_ORDER);
    for (size_t i = 0; i < o->count; i++)
        o->index[i] = (uint32_t)i;
    for (size_t i = o->count; i > 1; i--) {
        size_t k = (size_t)rng_below(&r, (int)i);
        uint32_t t = o->index[i - 1];
        o->index[i - 1] = o->index[k];
        o->index[k] = t;
    }
    o->epoch = epoch;
}

size_t train_order_at(train_order *o, uint64_t p)
{
    if (o->epoch != p / o->count) shuffle(o, p / o->count);
    return o->index[p % o->count];
}

double train_learning_rate(const train_config *c, size_t epoch, uint64_t presentation)
{
    uint64_t steps_done = presentation / (uint64_t)c->batch;
    double step = (double)steps_done + 1, epochs = (double)presentation / (double)epoch;
    double warm = c->warmup_steps ? fmin(1, step / c->warmup_steps) : 1;
    double halvings = c->halve_every_epochs > 0 ? floor(epochs / c->halve_every_epochs) : 0;
    return c->learning_rate * warm * exp2(-halvings);
}
