/* SPDX-License-Identifier: MIT */
/* From a graph to values and steps: what is live, what is fused, and which gradients flow.
 * Internal to src/nn; compile.c turns the result into a program. */
#ifndef MERLIN_NN_LOWER_H
#define MERLIN_NN_LOWER_H

#include "nn/device.h"
#include "nn/plan.h"

/* What becomes of one node. */
typedef struct lowered_value {
    const nn_node *node;
    int in[NN_MAX_INPUTS]; /* indices of nodes, conversions that do nothing skipped */
    bool live, is_output;
    bool reaches_loss;           /* by a way that passes gradients */
    bool covered;                /* by a step that started at an earlier node */
    int consumers;               /* uses by live nodes */
    int consumer;                /* the last of them */
    nn_tensor tensor;            /* shape and type */
    bool differentiable;         /* depends on a parameter, and a loss depends on it */
    int buffer, gradient_buffer; /* in the plan; -1: none */
} lowered_value;

/* One step before the device has seen it: the nodes it covers. */
typedef struct lowered_step {
    int head, norm, result; /* first node; folded batch norm or -1; the node whose value is written */
    int beside;             /* the node whose value a convolution adds to its own, or -1 */
    bool relu;
} lowered_step;

typedef struct lowering {
    const nn_graph *graph;
    nn_options options;
    lowered_value *values; /* per node */
    lowered_step *steps;
    int step_count;
} lowering;

/* options->type must be one that the device can use. */
status lower_graph(const nn_graph *g, const nn_options *options, lowering *out);
void lowering_free(lowering *l);

/* Whether options->outputs asks for this one. */
bool lower_wants_output(const nn_options *options, const char *name);
/* The index of the node that stands for x: conversions between equal types are skipped. */
int lower_resolve(nn_type compute, const nn_node *x);

#endif
