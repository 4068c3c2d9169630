/* SPDX-License-Identifier: MIT */
#include "lab/train/train_rates.h"

/* Slows down what the model of one photograph has, too. */
static status slow_single(const model_config *model, float scale, nn_params *params)
{
    model_config single = *model;
    nn_graph *graph = NULL;
    nn_params *names = NULL;
    single.several = false;
    status s = model_build(&single, MODEL_WHOLE, &graph);
    if (s == OK) s = nn_params_new(graph, 0, &names);
    nn_param *p;
    for (size_t i = 0; s == OK && (p = nn_params_at(params, i)); i++)
        if (nn_params_find(names, p->name)) p->learning_rate_scale *= scale;
    nn_params_free(names);
    nn_graph_free(graph);
    return s;
}

status train_rates_set(const model_config *model, const train_config *c, nn_params *params)
{
    nn_params_scale_rate(params, "encoder.", (float)c->encoder_rate_scale);
    return c->single_rate_scale == 1 ? OK : slow_single(model, (float)c->single_rate_scale, params);
}
