/* SPDX-License-Identifier: MIT */
/* Forward and backward of the operations over an object's pictures, for the table of ops.c; each unpacks a step's
 * tensors for the kernels. */
#ifndef MERLIN_NN_CPU_GROUP_OPS_H
#define MERLIN_NN_CPU_GROUP_OPS_H

#include "nn/device.h"

status group_max_forward(nn_step *step);
status group_max_backward(nn_step *step);
status group_mean_forward(nn_step *step);
status group_mean_backward(nn_step *step);
status group_spread_forward(nn_step *step);
status group_spread_backward(nn_step *step);
status group_repeat_forward(nn_step *step);
status group_repeat_backward(nn_step *step);
status group_attention_forward(nn_step *step);
status group_attention_backward(nn_step *step);
status group_pool_forward(nn_step *step);
status group_pool_backward(nn_step *step);
status layer_norm_forward(nn_step *step);
status layer_norm_backward(nn_step *step);
status gather_forward(nn_step *step);
status gather_backward(nn_step *step);

/* Return the bytes that a backward pass uses beside its tensors. */
size_t group_pool_scratch(const nn_step *step);
size_t layer_norm_scratch(const nn_step *step);
size_t gather_scratch(const nn_step *step);

#endif
