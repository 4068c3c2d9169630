/* SPDX-License-Identifier: MIT */
/* Normalization of each pixel over its channels (Ba et al. 2016), computed in float32 whatever the tensors' type. */
#ifndef MERLIN_NN_CPU_KERNELS_LAYER_NORM_H
#define MERLIN_NN_CPU_KERNELS_LAYER_NORM_H

#include "nn/cpu/kernels/kernels.h"

/* A weight and a bias for each channel, or their gradients. */
typedef struct layer_norm_params {
    float *weight, *bias;
} layer_norm_params;

/* Returns the room in floats that the backward pass needs. */
size_t layer_norm_partial_floats(int channels);
void cpu_layer_norm(const cpu_tensor *x, layer_norm_params params, cpu_tensor *y);
/* dx may have no data. The parameters' gradients are written. */
void cpu_layer_norm_backward(const cpu_tensor *x, layer_norm_params params, const cpu_tensor *dy, cpu_tensor *dx,
                             bool accumulate, float *partial, layer_norm_params gradients);

#endif
