/* SPDX-License-Identifier: MIT */
/* Loss curves: one CSV for training (means over curve_steps steps) and one for validation, and a chart of both. */
#ifndef MERLIN_LAB_TRAIN_CURVES_H
#define MERLIN_LAB_TRAIN_CURVES_H

#include <stdint.h>

#include "model/model.h"

/* Sums since the last row, stored in checkpoints so that a resumed run writes the same rows. */
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

/* Appends the means as one row; losses that the model lacks are empty fields. An empty or new file gets a header first.
 */
status train_curve_append(const char *path, const train_curve_row *row, const train_losses *l);
/* Flushes the file to disk, so that its rows are there before a checkpoint that follows them. A missing file is
 * ignored. */
status train_curve_keep(const char *path);
/* Removes rows after the step, as if the run had ended there. A missing file is ignored. */
status train_curve_truncate(const char *path, int64_t step);
/* Draws training and validation losses over presentations; without any data nothing is drawn. */
status train_curve_chart(const char *training_csv, const char *validation_csv, const char *png);

#endif
