/* The graph as the builder leaves it: nodes in topological order, shapes as channels and reduction, the first error.
 * Internal to src/nn. */
#ifndef MERLIN_NN_GRAPH_H
#define MERLIN_NN_GRAPH_H

#include "nn/nn.h"

typedef enum nn_op {
    OP_INPUT,
    OP_COMPUTE,
    OP_FLOAT,
    OP_CONV,
    OP_LINEAR,
    OP_NORM,
    OP_RELU,
    OP_TANH,
    OP_SIGMOID,
    OP_CONCAT,
    OP_SLICE,
    OP_ADD,
    OP_GATE,
    OP_SCALE_SHIFT,
    OP_UPSAMPLE_BILINEAR,
    OP_TILE,
    OP_SPACE_TO_DEPTH,
    OP_DEPTH_TO_SPACE,
    OP_SPATIAL_MEAN,
    OP_NORMALIZE,
    OP_RECIPROCAL,
    OP_RENDER,
    OP_ENVIRONMENT,
    OP_MASKED_L2,
    OP_MASKED_GRADIENT_L2,
    OP_MASKED_DSSIM,
} nn_op;

enum { NN_MAX_INPUTS = 8 };

typedef struct nn_attributes {
    int kernel, stride, block, first;
    bool bias, zero; /* zero: weights of a convolution before training */
    float scale, shift;
    float fov, light_power;
    float weight;       /* of a loss */
    float first_weight; /* batch norm's, before training */
} nn_attributes;

struct nn_node {
    nn_graph *graph;
    int index;
    nn_op op;
    char *name; /* of parameters, input or loss; NULL for the rest */
    nn_node *in[NN_MAX_INPUTS];
    int inputs;
    int channels, reduction;
    bool is_float;
    nn_attributes at;
};

typedef struct graph_output {
    nn_node *node;
    char *name;
} graph_output;

struct nn_graph {
    nn_node **nodes;
    int count, capacity;
    graph_output *outputs;
    int output_count;
    status error; /* the first one */
    char message[256];
};

/* Repeats the graph's first error, or OK. */
status graph_check(const nn_graph *g);
/* "conv2d", for messages and profiles. */
const char *op_name(nn_op op);

static inline bool op_is_loss(nn_op op)
{
    return op == OP_MASKED_L2 || op == OP_MASKED_GRADIENT_L2 || op == OP_MASKED_DSSIM;
}

/* Convolution and fully connected: a weight and maybe a bias. */
static inline bool op_is_conv(nn_op op)
{
    return op == OP_CONV || op == OP_LINEAR;
}

#endif
