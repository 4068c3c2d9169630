/* SPDX-License-Identifier: MIT */
/* The table of operations. */
#include "nn/op.h"

static const op_row rows[] = {
    [OP_INPUT] = {.name = "input"},
    [OP_COMPUTE] = {.name = "compute"},
    [OP_FLOAT] = {.name = "float"},
    [OP_CONV] = {.name = "conv2d", .is_conv = true, .has_params = true},
    [OP_CONV_TRANSPOSED] = {.name = "conv2d_transposed", .has_params = true},
    [OP_LINEAR] = {.name = "linear", .is_conv = true, .has_params = true},
    [OP_NORM] = {.name = "batch_norm", .has_params = true},
    [OP_RELU] = {.name = "relu"},
    [OP_TANH] = {.name = "tanh"},
    [OP_SIGMOID] = {.name = "sigmoid"},
    [OP_CONCAT] = {.name = "concat"},
    [OP_SLICE] = {.name = "slice"},
    [OP_ADD] = {.name = "add"},
    [OP_STOP] = {.name = "stop", .gradients = -1},
    [OP_GATE] = {.name = "gate"},
    [OP_SCALE_SHIFT] = {.name = "scale_shift"},
    [OP_UPSAMPLE_BILINEAR] = {.name = "upsample_bilinear"},
    [OP_TILE] = {.name = "tile"},
    [OP_SPACE_TO_DEPTH] = {.name = "space_to_depth"},
    [OP_DEPTH_TO_SPACE] = {.name = "depth_to_space"},
    [OP_SPATIAL_MEAN] = {.name = "spatial_mean"},
    [OP_NORMALIZE] = {.name = "normalize"},
    [OP_RECIPROCAL] = {.name = "reciprocal"},
    [OP_GROUP_MAX] = {.name = "group_max", .gradients = 1},
    [OP_GROUP_MEAN] = {.name = "group_mean", .gradients = 1},
    [OP_GROUP_SPREAD] = {.name = "group_spread", .gradients = 1},
    [OP_GROUP_REPEAT] = {.name = "group_repeat"},
    [OP_GROUP_ATTENTION] = {.name = "group_attention", .gradients = 1},
    [OP_GROUP_POOL] = {.name = "group_pool", .has_params = true, .gradients = 1},
    [OP_LAYER_NORM] = {.name = "layer_norm", .has_params = true},
    [OP_GATHER] = {.name = "gather", .gradients = 1},
    [OP_RENDER] = {.name = "render", .gradients = 4},           /* the maps; not mask, light and lens */
    [OP_ENVIRONMENT] = {.name = "environment", .gradients = 3}, /* not the mask */
    [OP_MASKED_L2] = {.name = "masked_l2", .is_loss = true, .gradients = 1},
    [OP_MASKED_GRADIENT_L2] = {.name = "masked_gradient_l2", .is_loss = true, .gradients = 1},
    [OP_MASKED_DSSIM] = {.name = "masked_dssim", .is_loss = true, .gradients = 1},
};
_Static_assert(sizeof rows / sizeof *rows == OP_COUNT, "every operation has a row");

const op_row *op_row_of(nn_op op)
{
    return &rows[op];
}
