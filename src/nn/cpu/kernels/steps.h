/* SPDX-License-Identifier: MIT */
/* The kinds of steps of the CPU device. Each create function reads what the compiler asked for and fills in the
 * device's part of the step. Internal to src/nn/cpu. */
#ifndef MERLIN_NN_CPU_KERNELS_STEPS_H
#define MERLIN_NN_CPU_KERNELS_STEPS_H

#include "nn/device.h"

/* Convolution, fully connected (a 1×1 convolution of 1×1 images): oneDNN. */
status conv_create(nn_step *step);
/* The two halves of a convolution's backward, to be timed one by one; gradients must be in the compute type. */
status conv_backward_data(nn_step *step);
status conv_backward_weights(nn_step *step);

/* Convolution by Winograd's filtering, and whether it can be computed so. */
bool winograd_suits(const nn_step *step);
status winograd_create(nn_step *step);

status norm_create(nn_step *step);

/* Any of these, or what nn/cpu/kernels/kernels.h computes, by the step's operation. */
status step_create(nn_step *step);

status cpu_measure_peak(void *context, nn_type type, nn_peak *out);

#endif
