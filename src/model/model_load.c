/* SPDX-License-Identifier: MIT */
/* Models from weights files. */
#include <string.h>

#include "model/model.h"
#include "nn/safetensors.h"

static status read_config(const safetensors_file *file, const char *weights, model_config *config)
{
    if (safetensors_metadata(file, "checkpoint"))
        return fail(MERLIN_BAD_INPUT,
                    "%s is a checkpoint of training, no model: that is weights.safetensors, once training wrote it",
                    weights);
    const char *json = safetensors_metadata(file, "config");
    if (json) return model_config_parse(json, strlen(json), weights, config);
    return fail(MERLIN_BAD_INPUT, "%s has no model configuration: these are not weights of merlin", weights);
}

static status load(const safetensors_file *file, const char *weights, model_config *config, nn_params **params)
{
    nn_graph *g = NULL;
    status s = read_config(file, weights, config);
    if (s == OK) s = model_build(config, MODEL_WHOLE, &g);
    if (s == OK) s = nn_params_open(g, file, weights, params);
    nn_graph_free(g);
    return s;
}

status model_load_config(const char *weights, model_config *config)
{
    safetensors_file *file;
    status s = safetensors_open(weights, &file);
    if (s != OK) return s;
    s = read_config(file, weights, config);
    safetensors_close(file);
    return s;
}

status model_load(const char *weights, model_config *config, nn_params **params)
{
    *params = NULL;
    safetensors_file *file;
    status s = safetensors_open(weights, &file);
    if (s != OK) return s;
    s = load(file, weights, config, params);
    safetensors_close(file);
    return s;
}
