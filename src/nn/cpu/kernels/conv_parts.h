/* SPDX-License-Identifier: MIT */
/* What a convolution does whatever computes it: batch norm folded into the weights, ReLU undone in the gradient, work
 * counted. Internal to src/nn/cpu. */
#ifndef MERLIN_NN_CPU_KERNELS_CONV_PARTS_H
#define MERLIN_NN_CPU_KERNELS_CONV_PARTS_H

#include "nn/device.h"

/* Up to a whole cache line. */
static inline size_t conv_align(size_t bytes)
{
    return (bytes + 63) / 64 * 64;
}

void conv_count_flops(nn_step *step);

/* Memory that the step keeps (base/memory.h), counted as its own. */
status conv_own(nn_step *step, size_t bytes, void **memory);

/* Float weights, with batch norm by running statistics folded into them where there is one, w' = w γ/√(σ² + ε) and
 * b' = β + (b - μ) γ/√(σ² + ε): made at `place`, for which they have so many bytes, or the parameter itself where these
 * are 0. A bias is allocated where there is one to fold, else NULL. */
size_t conv_weights_bytes(const nn_step *step);
status conv_own_folded_bias(nn_step *step, void **bias);
float *conv_weights(const nn_step *step, void *place);
void conv_make_weights(const nn_step *step, void *place, float *folded_bias);

/* The output's gradient in the compute type and masked by the fused ReLU: made at `place`, for which it has so many
 * bytes, or the gradient itself where these are 0. */
size_t conv_prepared_bytes(const nn_step *step);
void *conv_prepared(const nn_step *step, void *place);
void conv_prepare(const nn_step *step, void *place);

#endif
