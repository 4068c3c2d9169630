/* SPDX-License-Identifier: MIT */
/* A weights file of a small model with random parameters, for tests that care about everything but the answer. */
#ifndef MERLIN_TESTS_ESTIMATE_WEIGHTS_H
#define MERLIN_TESTS_ESTIMATE_WEIGHTS_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/model.h"
#include "nn/safetensors.h"

static inline status write_params(const char *path, nn_params *params, const char *config)
{
    size_t count = nn_params_count(params);
    safetensors_tensor *tensors = calloc(count, sizeof *tensors);
    for (size_t i = 0; i < count; i++) {
        const nn_param *p = nn_params_at(params, i);
        tensors[i] = (safetensors_tensor){
            .name = p->name, .type = SAFETENSORS_F32, .rank = p->rank, .count = p->count, .data = p->value};
        memcpy(tensors[i].shape, p->shape, sizeof p->shape);
    }
    const char *const metadata[][2] = {{"config", config}};
    status s = safetensors_write(path, tensors, count, metadata, 1);
    free(tensors);
    return s;
}

/* A network of configs/models, a few channels wide, with what it shares with another one's weights; shared NULL: none.
 */
static inline status write_shared_weights_of(const char *name, const char *shared, const char *path)
{
    char from[512];
    snprintf(from, sizeof from, "%s/configs/models/%s.json", MERLIN_SOURCE_DIR, name);
    model_config config;
    nn_graph *g = NULL;
    nn_params *params = NULL;
    status s = model_config_read(from, &config);
    for (int i = 0; i < MODEL_LEVELS; i++)
        config.widths[i] = config.gi_widths[i] = 16;
    char *json = s == OK ? model_config_write(&config) : NULL;
    if (s == OK) s = model_build(&config, MODEL_WHOLE, &g);
    if (s == OK) s = nn_params_new(g, 1, &params);
    if (s == OK && shared) s = nn_params_load_shared(params, shared);
    if (s == OK) s = write_params(path, params, json);
    free(json);
    nn_params_free(params);
    nn_graph_free(g);
    return s;
}

static inline status write_random_weights_of(const char *name, const char *path)
{
    return write_shared_weights_of(name, NULL, path);
}

static inline status write_random_weights(const char *path)
{
    return write_random_weights_of("merlin-point-plain", path);
}

#endif
