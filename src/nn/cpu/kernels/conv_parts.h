/* SPDX-License-Identifier: MIT */
/* The parts that all implementations of a convolution share: batch norm folded into the weights, ReLU's derivative in
 * the gradient, counting of operations. Internal to src/nn/cpu. */
#ifndef MERLIN_NN_CPU_KERNELS_CONV_PARTS_H
#define MERLIN_NN_CPU_KERNELS_CONV_PARTS_H

#include "nn/device.h"

/* Rounds up to a whole cache line. */
static inline size_t conv_align(size_t bytes)
{
    return (bytes + 63) / 64 * 64;
}

void conv_count_flops(nn_step *step);

/* Allocates memory for the step's lifetime (base/memory.h), counted as the step's own. */
status conv_own(nn_step *step, size_t bytes, void **memory);

/* Compute float weights, with batch norm by running statistics folded in where there is one: w' = w γ/√(σ² + ε) and b'
 * = β + (b - μ) γ/√(σ² + ε). They are stored at `place`, which must have conv_weights_bytes; if that is 0 they are the
 * parameter itself. The bias is allocated if there is one to fold, else NULL. */
size_t conv_weights_bytes(const nn_step *step);
status conv_own_folded_bias(nn_step *step, void **bias);
float *conv_weights(const nn_step *step, void *place);
void conv_make_weights(const nn_step *step, void *place, float *folded_bias);

/* Compute the output's gradient in the compute type, multiplied by the fused ReLU's derivative. It is stored at
 * `place`, which must have conv_prepared_bytes; if that is 0 it is the gradient itself. */
size_t conv_prepared_bytes(const nn_step *step);
void *conv_prepared(const nn_step *step, void *place);
void conv_prepare(const nn_step *step, void *place);

#endif
