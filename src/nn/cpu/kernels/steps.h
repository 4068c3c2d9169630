/* SPDX-License-Identifier: MIT */
/* The kinds of steps of the CPU device. Each create function reads the compiler's description and fills in the device's
 * part of the step. Internal to src/nn/cpu. */
#ifndef MERLIN_NN_CPU_KERNELS_STEPS_H
#define MERLIN_NN_CPU_KERNELS_STEPS_H

#include "nn/device.h"

/* Creates a convolution or fully connected layer (a 1×1 convolution of 1×1 images), by oneDNN. */
status conv_create(nn_step *step);
/* Run the two halves of a convolution's backward pass, for timing them separately; gradients must be in the compute
 * type. */
status conv_backward_data(nn_step *step);
status conv_backward_weights(nn_step *step);

/* Tells whether a convolution can be computed by Winograd's filtering, and creates one. */
bool winograd_suits(const nn_step *step);
status winograd_create(nn_step *step);

/* Creates a transposed convolution, by oneDNN's gradients of a convolution. */
status transposed_create(nn_step *step);

status norm_create(nn_step *step);

/* Creates any of these steps, or one computed by nn/cpu/kernels/kernels.h, by the step's operation. */
status step_create(nn_step *step);

status cpu_measure_peak(void *context, nn_type type, nn_peak *out);

#endif
