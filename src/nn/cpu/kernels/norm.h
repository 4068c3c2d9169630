/* SPDX-License-Identifier: MIT */
/* Batch normalization (Ioffe & Szegedy 2015) over rows of channels, optionally followed by ReLU.
 *
 * Rows are N·H·W, float32 or bfloat16. Statistics are sums over a fixed number of chunks of rows, combined in double in
 * order, so that results do not depend on the number of threads. Internal to src/nn/cpu. */
#ifndef MERLIN_NN_CPU_KERNELS_NORM_H
#define MERLIN_NN_CPU_KERNELS_NORM_H

#include "base/ranks/ranks.h"
#include "nn/tensor.h"

#define NORM_EPSILON 1e-5f

/* Returns the floats of workspace for a number of channels. */
size_t norm_partial_floats(int channels);

/* Computes mean and biased variance per channel, over the rows of all ranks. sums: room for two doubles a channel.
 * MERLIN_NO_MEMORY. */
status norm_statistics(const nn_tensor *x, const ranks *together, float *partial, double *sums, float *mean,
                       float *variance);
/* Computes y = scale x + shift per channel, then ReLU. */
void norm_apply(const nn_tensor *x, const float *scale, const float *shift, bool relu, nn_tensor *y);

/* Arrays with one entry per channel. */
typedef struct norm_channels {
    const float *mean, *inverse_deviation, *gamma, *beta;
    float *dgamma, *dbeta;
} norm_channels;
/* Computes dx (added to if accumulate), dgamma and dbeta from dy; ReLU's mask is recomputed from x. dx NULL: not
 * needed. dgamma and dbeta are this rank's share. sums as above. MERLIN_NO_MEMORY. */
status norm_backward(const nn_tensor *x, const nn_tensor *dy, bool relu, const norm_channels *c, const ranks *together,
                     float *partial, double *sums, nn_tensor *dx, bool accumulate);

#endif
