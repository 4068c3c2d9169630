/* SPDX-License-Identifier: MIT */
/* merlin/weights.h: the content of a weights file. */
#include "merlin/weights.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/api_needs.h"
#include "model/model.h"
#include "nn/safetensors.h"

static status measure_cost(const model_config *config, nn_params *params, double *gmac)
{
    nn_graph *g = NULL;
    nn_program *p = NULL;
    nn_options options = {.batch = 1, .height = MERLIN_COST_SIDE, .width = MERLIN_COST_SIDE, .purpose = NN_INFER};
    status s = model_build(config, MODEL_WHOLE, &g);
    if (s == OK) s = nn_compile(g, params, &options, &p);
    if (s == OK) *gmac = nn_program_cost(p).forward_flops / 2e9;
    nn_program_free(p);
    nn_graph_free(g);
    return s;
}

/* Fills in everything but tensors. */
static status read_model(const char *path, merlin_weights *out)
{
    model_config config;
    nn_params *params = NULL;
    status s = model_load(path, &config, &params);
    if (s != OK) return s;
    snprintf(out->name, sizeof out->name, "%s", config.name);
    for (size_t i = 0; i < nn_params_count(params); i++) {
        const nn_param *p = nn_params_at(params, i);
        *(p->gradient ? &out->parameters : &out->statistics) += p->count;
    }
    s = measure_cost(&config, params, &out->gmac);
    nn_params_free(params);
    return s;
}

static status list_tensors(const safetensors_file *file, merlin_weights *out)
{
    const size_t count = safetensors_count(file);
    out->tensors = calloc(count + 1, sizeof *out->tensors);
    if (!out->tensors) return fail(MERLIN_NO_MEMORY, "no memory for a list of %zu tensors", count);
    for (size_t i = 0; i < count; i++) {
        const safetensors_tensor *t = safetensors_at(file, i);
        merlin_tensor *listed = &out->tensors[i];
        *listed = (merlin_tensor){.name = t->name, .type = safetensors_type_name(t->type), .rank = t->rank};
        memcpy(listed->shape, t->shape, sizeof listed->shape);
    }
    out->tensor_count = count;
    return OK;
}

merlin_status merlin_weights_read(const char *path, merlin_weights *out)
{
    if (out) *out = (merlin_weights){.file = NULL};
    status s = api_needs(__func__, path && out);
    if (s != OK) return s;
    safetensors_file *file = NULL;
    s = read_model(path, out);
    if (s == OK) s = safetensors_open(path, &file);
    out->file = file;
    if (s == OK) s = list_tensors(file, out);
    if (s != OK) merlin_weights_free(out);
    return s;
}

const char *merlin_weights_metadata(const merlin_weights *weights, const char *name)
{
    return weights && weights->file && name ? safetensors_metadata(weights->file, name) : NULL;
}

void merlin_weights_free(merlin_weights *weights)
{
    if (!weights) return;
    free(weights->tensors);
    safetensors_close(weights->file);
    *weights = (merlin_weights){.file = NULL};
}
