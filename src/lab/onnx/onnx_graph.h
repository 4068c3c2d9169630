/* SPDX-License-Identifier: MIT */
/* The operations of a network as nodes of an ONNX graph. */
#ifndef MERLIN_LAB_ONNX_ONNX_GRAPH_H
#define MERLIN_LAB_ONNX_ONNX_GRAPH_H

#include "lab/onnx/onnx_message.h"
#include "nn/graph.h"

/* An ONNX graph while it grows. */
typedef struct onnx_graph {
    protobuf message;
    const nn_graph *source;
    nn_params *params;
    int size;      /* size of onnx_options */
    bool *written; /* one a parameter: it is a constant of the graph already */
    status error;  /* the first one */
} onnx_graph;

/* Tells whether ONNX has a counterpart of the operation. */
bool onnx_knows(nn_op op);

/* Composes the name of a node's value and returns it. */
const char *onnx_value_name(const nn_node *x, char name[ONNX_NAME]);

/* Adds what computes a node's value from its inputs' values; nothing for an input of the network. */
void onnx_put_node(onnx_graph *g, const nn_node *x);

#endif
