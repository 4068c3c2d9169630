/* SPDX-License-Identifier: MIT */
/* A convolution's primitives and weights, of an ordinary and of a transposed one alike. Activations are channels-last.
 * Weights are float32 in PyTorch's order outside; each primitive gets a copy in the layout and type it asked for,
 * converted again after every change, with batch norm by running statistics folded into it. */
#ifndef MERLIN_NN_CPU_DNN_DNN_CONV_STATE_H
#define MERLIN_NN_CPU_DNN_DNN_CONV_STATE_H

#include "nn/cpu/dnn/dnn.h"

typedef struct dnn_conv_state {
    dnn_call forward, data, weights;
    dnn_call convert, convert_back, collect; /* weights to forward and backward-data; gradient from weights */
    dnn_shape plain;                         /* the float32 weights */
    void *folded_bias, *forward_weights, *data_weights, *weight_gradient;
    bool has_bias, adds_behind; /* adds_behind: the sum and ReLU are computed behind the primitive */
} dnn_conv_state;

/* Allocates memory of this layout, which the step accounts for. */
status dnn_conv_own(nn_step *step, dnn_layout layout, void **memory);
/* Converts the weights, as step_functions' refresh. */
status dnn_conv_refresh(nn_step *step);
/* Makes the call that collects the weights' gradient from its own layout. */
status dnn_conv_collect(const nn_step *step, dnn_conv_state *state);
void dnn_conv_release(nn_step *step);

#endif
