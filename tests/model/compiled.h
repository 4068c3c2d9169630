/* SPDX-License-Identifier: MIT */
/* What tests of the model share: a program of one of its parts. */
#ifndef MERLIN_TESTS_MODEL_COMPILED_H
#define MERLIN_TESTS_MODEL_COMPILED_H

#include "model/model.h"

/* In float32, for batch pictures of size × size. *params, if NULL, becomes the model's random ones. NULL on failure. */
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
