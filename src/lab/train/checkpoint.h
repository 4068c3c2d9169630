/* SPDX-License-Identifier: MIT */
/* A training run on disk: parameters, Adam's moments, the weights' mean, counters and the open row of the curves, in
 * one safetensors file written at once or not at all. */
#ifndef MERLIN_LAB_TRAIN_CHECKPOINT_H
#define MERLIN_LAB_TRAIN_CHECKPOINT_H

#include "lab/train/average.h"
#include "lab/train/curves.h"
#include "lab/train/train_config.h"

typedef struct train_state {
    int64_t step;
    double best; /* lowest validation loss so far */
    train_losses open;
} train_state;

/* What must be the same for a run to go on: texts of the configuration, and the data set's size. */
typedef struct train_identity {
    const char *model, *training;
    size_t samples;
    int ranks; /* processes: other numbers add up otherwise */
} train_identity;

/* What a step changes. */
typedef struct train_learner {
    nn_params *params;
    nn_adam *adam;
    train_average *average; /* may be NULL */
} train_learner;

status train_checkpoint_write(const char *path, const train_learner *learner, const train_state *state,
                              const train_identity *identity);
/* Gives every rank what rank 0 has. */
void train_checkpoint_share(const ranks *together, const train_learner *learner, train_state *state);
/* Refuses a checkpoint of another data set, number of ranks or configuration, but for memory_gib and
 * checkpoint_minutes. */
status train_checkpoint_read(const char *path, const train_learner *learner, train_state *state,
                             const train_identity *identity);

typedef struct train_provenance {
    const char *config; /* the model's, JSON */
    const char *training;
    const char *note; /* such as the commit; may be NULL */
    int64_t presentations, samples;
    int size, generator_version;
    double validation_loss; /* infinite: there was no validation, and the weights say nothing of it */
} train_provenance;

/* Weights for everybody (model_load): half floats, batch norm's statistics float32, with the model's configuration and
 * where they come from in the metadata. */
status train_export(const char *path, nn_params *params, const train_provenance *from);

#endif
