/* SPDX-License-Identifier: MIT */
/* Fills a training program's inputs with one batch, samples in parallel. */
#ifndef MERLIN_LAB_TRAIN_FEED_H
#define MERLIN_LAB_TRAIN_FEED_H

#include "lab/train/config.h"
#include "lab/train/dataset.h"
#include "lab/train/schedule.h"

typedef struct trn_feed trn_feed;

/* The samples of the data set before `training_count` are for training, the others are held back. */
typedef struct trn_source {
    trn_dataset *data;
    const train_config *config;
    bool input_global;
    bool environment; /* setting B; the data set has environments */
    bool any;         /* any light, any lens; the data set has lamps */
    size_t training_count;
    int batch; /* of the program: a rank's share of the configuration's */
} trn_source;

status trn_feed_new(nn_program *program, const trn_source *source, trn_feed **out);
void trn_feed_free(trn_feed *f);

/* Presentations first .. first + batch - 1, turned and photographed at random from (seed, presentation). */
status trn_feed_training(trn_feed *f, trn_order *order, uint64_t first);
/* Held-back samples first .. first + batch - 1 as they are, each under a target light of its own. */
status trn_feed_validation(trn_feed *f, size_t first);

#endif
