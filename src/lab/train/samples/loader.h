/* SPDX-License-Identifier: MIT */
/* Data loader: fills a training program's inputs with one batch, preparing samples in parallel. */
#ifndef MERLIN_LAB_TRAIN_SAMPLES_LOADER_H
#define MERLIN_LAB_TRAIN_SAMPLES_LOADER_H

#include "lab/train/config/schedule.h"
#include "lab/train/config/train_config.h"
#include "lab/train/samples/dataset.h"

typedef struct train_loader train_loader;

/* The source of the samples. Those before `training_count` are for training, the others for validation. */
typedef struct train_source {
    train_dataset *data;
    const train_config *config;
    bool input_global;
    bool environment; /* setting B; the data set has environments */
    bool any;         /* any light, any lens; the data set has lamps */
    bool nfps;        /* the network of near lights; the data set has targets, and twice the configuration's size */
    size_t training_count;
    int batch;    /* of the program: a rank's share of the configuration's */
    int pictures; /* of each object: consecutive presentations show the first one's sample, each in its own light */
} train_source;

status train_loader_new(nn_program *program, const train_source *source, train_loader **out);
void train_loader_free(train_loader *l);

/* Loads presentations first .. first + batch - 1, turned and photographed at random from (seed, presentation). */
status train_loader_training(train_loader *l, train_order *order, uint64_t first);
/* Loads validation samples first .. first + batch - 1 unchanged, each under a target light of its own. */
status train_loader_validation(train_loader *l, size_t first);

#endif
