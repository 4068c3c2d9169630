/* SPDX-License-Identifier: MIT */
/* The graph as the builder leaves it: nodes in topological order, shapes as channels and reduction, the first error.
 * Internal to src/nn. */
#ifndef MERLIN_NN_GRAPH_H
#define MERLIN_NN_GRAPH_H

#include "nn/nn.h"
#include "nn/op.h"

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

#endif
