/* SPDX-License-Identifier: MIT */
/* A training run on disk: parameters, Adam's moments, the weights' mean, counters and the unfinished row of the curves,
 * in one safetensors file that is written atomically. */
#ifndef MERLIN_LAB_TRAIN_CHECKPOINT_H
#define MERLIN_LAB_TRAIN_CHECKPOINT_H

#include "lab/train/average.h"
#include "lab/train/config/train_config.h"
#include "lab/train/curves.h"

typedef struct train_state {
    int64_t step;
    double best; /* lowest validation loss so far */
    train_losses open;
} train_state;

/* What must be the same for a run to be resumed: the configuration as text, the data set's size, the number of ranks.
 */
typedef struct train_identity {
    const char *model, *training;
    size_t samples;
    int ranks; /* number of processes, which affects the order of sums */
} train_identity;

/* Everything that a training step changes. */
typedef struct train_learner {
    nn_params *params;
    nn_adam *adam;
    train_average *average; /* may be NULL */
} train_learner;

status train_checkpoint_write(const char *path, const train_learner *learner, const train_state *state,
                              const train_identity *identity);
/* Copies rank 0's state to every rank. */
void train_checkpoint_share(const ranks *together, const train_learner *learner, train_state *state);
/* Reads a checkpoint. Refuses one of another data set, number of ranks or configuration, except for memory_gib and
 * checkpoint_minutes. */
status train_checkpoint_read(const char *path, const train_learner *learner, train_state *state,
                             const train_identity *identity);

typedef struct train_provenance {
    const char *config; /* the model's configuration, JSON */
    const char *training;
    const char *note; /* such as the commit; may be NULL */
    int64_t presentations, samples;
    int size, generator_version;
    double validation_loss; /* infinite: there was no validation, and the weights do not mention it */
} train_provenance;

/* Writes weights for distribution (model_load): half floats, batch norm's statistics float32, with the model's
 * configuration and the weights' origin in the metadata. */
status train_export(const char *path, nn_params *params, const train_provenance *from);

#endif
