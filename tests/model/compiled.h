/* SPDX-License-Identifier: MIT */
/* Shared by tests of the model: compiles a program of one of its parts. */
#ifndef MERLIN_TESTS_MODEL_COMPILED_H
#define MERLIN_TESTS_MODEL_COMPILED_H

#include "model/model.h"

/* Compiles a part in float32, for `batch` pictures of size × size. If *params is NULL it becomes the model's random
 * parameters. NULL on failure. */
static inline nn_program *compiled(const model_config *config, model_part part, nn_purpose purpose, int batch, int size,
                                   nn_params **params)
{
    nn_graph *g = NULL;
    nn_program *p = NULL;
    nn_options options = {.batch = batch, .height = size, .width = size, .type = NN_FLOAT32, .purpose = purpose};
    status s = model_build(config, part, &g);
    if (s == OK && !*params) s = nn_params_new(g, 7, params);
    if (s == OK) s = nn_compile(g, *params, &options, &p);
    nn_graph_free(g);
    return p;
}

#endif
