/* SPDX-License-Identifier: MIT */
/* The graph that the builder functions make: nodes in topological order, shapes as channels and reduction, the first
 * error. Internal to src/nn. */
#ifndef MERLIN_NN_GRAPH_H
#define MERLIN_NN_GRAPH_H

#include "nn/nn.h"
#include "nn/op.h"

enum { NN_MAX_INPUTS = 8 };

typedef struct nn_attributes {
    int kernel, stride, dilation, block, first, heads; /* dilation: of convolutions, 1: none */
    int reduction;                                     /* of the map that gather reads */
    bool bias, zero;                                   /* zero: initial weights of a convolution are 0 */
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
    bool is_float, of_object; /* of_object: an image for each object instead of each picture */
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

/* ---- what builder functions are made of ---- */

/* Notes the graph's first error; returns NULL. */
__attribute__((format(printf, 2, 3))) nn_node *graph_reject(nn_graph *g, const char *format, ...);
/* Appends a node that takes channels, reduction, precision and kind (of objects or not) from its first input. Inputs
 * may be of both kinds if `mixed`. */
nn_node *graph_append(nn_graph *g, nn_op op, nn_node *const *in, int inputs, bool mixed);
/* Appends an operation with parameters, in compute precision. */
nn_node *graph_append_named(nn_graph *g, nn_op op, nn_node *x, const char *name, int channels);
/* Names a node; parameters, inputs and losses each have a space of names of their own. */
nn_node *graph_give_name(nn_node *node, const char *name);

#endif
