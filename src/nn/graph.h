/* SPDX-License-Identifier: MIT */
/* The graph that the builder functions make: nodes in topological order, shapes as channels and reduction, the first
 * error. Internal to src/nn. */
#ifndef MERLIN_NN_GRAPH_H
#define MERLIN_NN_GRAPH_H

#include "nn/nn.h"
#include "nn/op.h"

enum { NN_MAX_INPUTS = 8 };

typedef struct nn_attributes {
    int kernel, stride, block, first;
    bool bias, zero; /* zero: initial weights of a convolution are 0 */
    float scale, shift;
    float fov, light_power;
    float weight;       /* of a loss */
    float first_weight; /* initial weight of batch norm */
} nn_attributes;

struct nn_node {
    nn_graph *graph;
    int index;
    nn_op op;
    char *name; /* of parameters, input or loss; NULL for other nodes */
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
    status error; /* first error */
    char message[256];
};

/* Returns the graph's first error again, or OK. */
status graph_check(const nn_graph *g);

#endif
