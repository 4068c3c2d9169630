/* SPDX-License-Identifier: MIT */
/* Internals of parameters: what programs need beyond nn.h. Internal to src/nn. */
#ifndef MERLIN_NN_PARAMS_H
#define MERLIN_NN_PARAMS_H

#include "nn/graph.h"

struct nn_params {
    nn_param *items, **by_name;
    size_t count;
    uint64_t version; /* incremented whenever values change */
    size_t value_count, gradient_count;
    float *values, *gradients; /* arrays that the items point into */
    uint16_t *halves;          /* NULL if none are kept as half floats */
};

/* Copies every parameter's values from the file's tensor of its name; if one is missing none is changed. */
status params_take(nn_params *params, const struct safetensors_file *f, const char *path);
/* Makes parameters with zeros where nn_params_new has random numbers. */
status params_like(const nn_graph *g, const struct safetensors_file *f, nn_params **out);

/* The parameters that an operation may have; absent ones are NULL. */
typedef struct node_params {
    nn_param *weight, *bias, *running_mean, *running_var;
} node_params;

/* Finds a node's parameters and checks their shapes. */
status params_of_node(nn_params *params, const nn_node *node, node_params *out);

#endif
