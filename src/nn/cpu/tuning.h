/* SPDX-License-Identifier: MIT */
/* Chooses the faster implementation for each kind of processor, by what `merlin-lab bench --layers` measured there. It
 * is a table, so that the same machine always computes the same bits. Internal to src/nn/cpu. */
#ifndef MERLIN_NN_CPU_TUNING_H
#define MERLIN_NN_CPU_TUNING_H

#include "nn/device.h"

/* Returns `wanted`, or float32 if this processor cannot compute in it. */
nn_type tuning_usable_type(nn_type wanted);
nn_type tuning_fastest_type(void);
/* Tells whether to compute a convolution by Winograd's filtering (winograd.h), which suits 3×3 ones without stride. */
bool tuning_filters(const nn_step *step);

#endif
