/* SPDX-License-Identifier: MIT */
/* Loss curves: one CSV for training (means over curve_steps steps) and one for validation, and a picture of both. */
#ifndef MERLIN_LAB_TRAIN_CURVES_H
#define MERLIN_LAB_TRAIN_CURVES_H

#include <stdint.h>

#include "model/model.h"

/* Sums since the last row: kept in checkpoints, so that a resumed run writes the same rows. */
typedef struct train_losses {
    double total, each[MODEL_LOSSES];
    int64_t count;
} train_losses;

/* Adds a program's losses after nn_forward. */
void train_losses_add(train_losses *l, const nn_program *p);

typedef struct train_curve_row {
    int64_t step, presentations, skipped;
    double learning_rate;
} train_curve_row;

/* Appends the means as one row; losses the model lacks are empty fields. An empty or new file
 * begins with a header. */
status train_curve_append(const char *path, const train_curve_row *row, const train_losses *l);
/* So that its rows are on the disk before a checkpoint that stands behind them. A missing file is fine. */
status train_curve_keep(const char *path);
/* Drops rows behind the step, as if the run had ended there. A missing file is fine. */
status train_curve_truncate(const char *path, int64_t step);
/* Draws training and validation losses over presentations; nothing to draw is fine. */
status train_curve_chart(const char *training_csv, const char *validation_csv, const char *png);

#endif
