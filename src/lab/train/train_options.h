/* SPDX-License-Identifier: MIT */
/* Options of a run (train.h). */
#ifndef MERLIN_LAB_TRAIN_TRAIN_OPTIONS_H
#define MERLIN_LAB_TRAIN_TRAIN_OPTIONS_H

#include <stdbool.h>

#include "base/ranks/ranks.h"

typedef struct train_options {
    const char *config, *data, *output;
    const char *init; /* weights to start from, or NULL */
    /* Other models' weights, ended by NULL: tensors that fit by name and shape are taken, from the last file that has
     * them. */
    const char *const *init_shared;
    const char *note; /* stored in the weights' metadata, such as the commit; or NULL */
    bool resume;      /* continue from the output folder's checkpoint; without, such a folder is refused */
    bool quiet;
    int (*interrupted)(void); /* called after every step; NULL: never */
    ranks *together;          /* NULL, or processes that share every batch: only rank 0 writes */
} train_options;

#endif
