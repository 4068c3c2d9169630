/* SPDX-License-Identifier: MIT */
/* The operations of a network, and what graph and compiler know about each on any device: a row of op.c's table. Its
 * implementation is in a table of the device (cpu/ops.c). Internal to src/nn. */
#ifndef MERLIN_NN_OP_H
#define MERLIN_NN_OP_H

#include <stdbool.h>

typedef enum nn_op {
    OP_INPUT,
    OP_COMPUTE,
    OP_FLOAT,
    OP_CONV,
    OP_CONV_TRANSPOSED,
    OP_LINEAR,
    OP_NORM,
    OP_RELU,
    OP_TANH,
    OP_SIGMOID,
    OP_CONCAT,
    OP_SLICE,
    OP_ADD,
    OP_STOP,
    OP_GATE,
    OP_SCALE_SHIFT,
    OP_UPSAMPLE_BILINEAR,
    OP_TILE,
    OP_SPACE_TO_DEPTH,
    OP_DEPTH_TO_SPACE,
    OP_SPATIAL_MEAN,
    OP_NORMALIZE,
    OP_RECIPROCAL,
    OP_GROUP_MAX,
    OP_GROUP_MEAN,
    OP_GROUP_SPREAD,
    OP_GROUP_REPEAT,
    OP_GROUP_ATTENTION,
    OP_GROUP_POOL,
    OP_LAYER_NORM,
    OP_GATHER,
    OP_RENDER,
    OP_ENVIRONMENT,
    OP_MASKED_L2,
    OP_MASKED_GRADIENT_L2,
    OP_MASKED_DSSIM,
    OP_COUNT
} nn_op;

typedef struct op_row {
    const char *name; /* such as "conv2d", for messages and profiles */
    bool is_conv;     /* convolution and fully connected: a weight and maybe a bias */
    bool is_loss;
    bool has_params;
    int gradients; /* number of its inputs, from the first, that a gradient flows to; 0: all, -1: none */
} op_row;

const op_row *op_row_of(nn_op op);

static inline const char *op_name(nn_op op)
{
    return op_row_of(op)->name;
}

static inline bool op_is_conv(nn_op op)
{
    return op_row_of(op)->is_conv;
}

static inline bool op_is_loss(nn_op op)
{
    return op_row_of(op)->is_loss;
}

static inline bool op_has_params(nn_op op)
{
    return op_row_of(op)->has_params;
}

/* Tells whether a gradient flows to an operation's k-th input. */
static inline bool op_passes_gradient(nn_op op, int k)
{
    int gradients = op_row_of(op)->gradients;
    return gradients == 0 || k < gradients;
}

#endif
