/* SPDX-License-Identifier: MIT */
/* tiny_model FILE: weights of a tiny network of both decoders, as random as training begins with. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "model/model.h"
#include "nn/safetensors.h"

static status write(const char *path, nn_params *params, const char *config)
{
    const char *const metadata[][2] = {
        {"config", config}, {"training", "{}"}, {"presentations", "4"}, {"note", "tiny"}};
    size_t count = nn_params_count(params);
    st_tensor *tensors = calloc(count, sizeof *tensors);
    uint16_t *halves = calloc(nn_params_values(params) + 1, sizeof *halves), *next = halves;
    if (!tensors || !halves) return fail(ERROR_MEMORY, "no memory for %zu tensors", count);
    for (size_t i = 0; i < count; i++) {
        const nn_param *p = nn_params_at(params, i);
        tensors[i] = (st_tensor){.name = p->name, .type = ST_F32, .rank = p->rank, .count = p->count, .data = p->value};
        memcpy(tensors[i].shape, p->shape, sizeof p->shape);
        if (p->rank == 1) continue; /* as batch norms are kept */
        tensors[i].type = ST_F16;
        tensors[i].data = next;
        for (size_t k = 0; k < p->count; k++)
            *next++ = float_to_half(p->value[k]);
    }
    status s = st_write(path, tensors, count, metadata, sizeof metadata / sizeof *metadata);
    free(tensors);
    free(halves);
    return s;
}

int main(int argc, char **argv)
{
    if (argc != 2) return 2;
    const model_config config = {.name = "tiny",
                                 .input_global = true,
                                 .material_decoders = 1,
                                 .feature_sharing = true,
                                 .gated_attention = true,
                                 .relight = MODEL_RELIGHT_NETWORK,
                                 .global_illumination = true,
                                 .widths = {8, 8, 8, 8, 8},
                                 .gi_widths = {8, 8, 8, 8, 8}};
    nn_graph *g = NULL;
    nn_params *params = NULL;
    char *json = model_config_write(&config);
    status s = json ? model_build(&config, MODEL_WHOLE, &g) : fail(ERROR_MEMORY, "no memory");
    if (s == OK) s = nn_params_new(g, 1, &params);
    if (s == OK) s = write(argv[1], params, json);
    if (s != OK) fprintf(stderr, "%s\n", status_message());
    nn_params_free(params);
    nn_graph_free(g);
    free(json);
    return s != OK;
}
