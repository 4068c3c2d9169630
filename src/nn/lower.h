/* SPDX-License-Identifier: MIT */
/* Lowers a graph to values and steps: which nodes are live, which are fused, and where gradients flow. Internal to
 * src/nn; compile.c turns the result into a program. */
#ifndef MERLIN_NN_LOWER_H
#define MERLIN_NN_LOWER_H

#include "nn/device.h"
#include "nn/plan.h"

/* The value of one node. */
typedef struct lowered_value {
    const nn_node *node;
    int in[NN_MAX_INPUTS]; /* indices of nodes; conversions that do nothing are skipped */
    bool live, is_output;
    bool reaches_loss;           /* along a path that passes gradients */
    bool covered;                /* by a step that starts at an earlier node */
    int consumers;               /* number of uses by live nodes */
    int consumer;                /* the last of them */
    nn_tensor tensor;            /* shape and type */
    bool differentiable;         /* depends on a parameter, and a loss depends on it */
    int buffer, gradient_buffer; /* indices in the plan; -1: none */
} lowered_value;

/* The nodes that one step covers. */
typedef struct lowered_step {
    int head, norm, result; /* first node; folded batch norm or -1; node whose value is written */
    int beside;             /* node whose value a convolution adds to its own, or -1 */
    bool relu;
} lowered_step;

typedef struct lowering {
    const nn_graph *graph;
    nn_options options;
    lowered_value *values; /* per node */
    lowered_step *steps;
    int step_count;
} lowering;

/* Lowers a graph. options->type must be supported by the device. */
status lower_graph(const nn_graph *g, const nn_options *options, lowering *out);
void lowering_free(lowering *l);

/* Tells whether options->outputs contains this one. */
bool lower_wants_output(const nn_options *options, const char *name);
/* Returns the index of the node that x is computed by: conversions between equal types are skipped. */
int lower_resolve(nn_type compute, const nn_node *x);

#endif
