/* SPDX-License-Identifier: MIT */
/* Shared by tests of the model: programs of its parts, and their gradients. */
#ifndef MERLIN_TESTS_MODEL_COMPILED_H
#define MERLIN_TESTS_MODEL_COMPILED_H

#include <math.h>
#include <string.h>

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

/* Returns the sum of the absolute values of the gradients of all parameters whose names begin with a prefix. */
static inline double size_of_gradients(nn_params *params, const char *prefix)
{
    double sum = 0;
    for (size_t i = 0; i < nn_params_count(params); i++) {
        const nn_param *p = nn_params_at(params, i);
        for (size_t k = 0; p->gradient && strncmp(p->name, prefix, strlen(prefix)) == 0 && k < p->count; k++)
            sum += fabs((double)p->gradient[k]);
    }
    return sum;
}

#endif
