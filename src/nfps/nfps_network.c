/* SPDX-License-Identifier: MIT */
#include "nfps/nfps_network.h"

#include <stdlib.h>
#include <string.h>

#include "model/model.h"

struct merlin_near_network {
    model_config config;
    nn_params *params;
    nn_graph *stage[2]; /* of the first scale, and of all others */
    nn_type type;
};

status nfps_network_open(const char *weights, nfps_network **out)
{
    *out = NULL;
    nfps_network *n = calloc(1, sizeof *n);
    if (!n) return fail(MERLIN_NO_MEMORY, "no memory for a model");
    n->type = nn_fastest_type();
    status s = model_load_config(weights, &n->config);
    if (s == OK && !n->config.nfps_width)
        s = fail(MERLIN_BAD_INPUT, "%s: model \"%s\" is none for pictures under known lights", weights, n->config.name);
    if (s == OK) s = model_load(weights, &n->config, &n->params);
    if (s == OK) s = model_build(&n->config, MODEL_FIRST, &n->stage[0]);
    if (s == OK) s = model_build(&n->config, MODEL_REFINE, &n->stage[1]);
    if (s != OK)
        nfps_network_close(n);
    else
        *out = n;
    return s;
}

void nfps_network_close(nfps_network *n)
{
    if (!n) return;
    nn_graph_free(n->stage[0]);
    nn_graph_free(n->stage[1]);
    nn_params_free(n->params);
    free(n);
}

const char *nfps_network_name(const nfps_network *n)
{
    return n->config.name;
}

static status run(nn_program *p, const nfps_scene *scene, const float *images, const float *known, float *normal)
{
    float *workspace = malloc((size_t)scene->pictures * scene->pixels * sizeof *workspace);
    float *mask = nn_input_data(p, "mask");
    if (!workspace) return fail(MERLIN_NO_MEMORY, "no memory for %d pictures", scene->pictures);
    const nfps_arrays in = {nn_input_data(p, "picture"), nn_input_data(p, "light"), nn_input_data(p, "matte")};
    nfps_encode(scene, images, workspace, &in);
    free(workspace);
    for (size_t i = 0; i < scene->pixels; i++)
        mask[i] = scene->mask[i] > 0.5f ? 1 : 0;
    if (known) nfps_turn_all(scene, known, nn_input_data(p, "normal"));
    status s = nn_forward(p);
    if (s == OK) nfps_turn_back_all(scene, nn_output_data(p, "normal"), normal);
    return s;
}

status nfps_network_run(const nfps_network *n, const nfps_scene *scene, int size, const float *images,
                        const float *known, float *normal)
{
    const nn_options options = {.batch = scene->pictures,
                                .group = scene->pictures,
                                .height = size,
                                .width = size,
                                .type = n->type,
                                .purpose = NN_INFER};
    nn_program *p = NULL;
    status s = nn_compile(n->stage[known != NULL], n->params, &options, &p);
    if (s == OK) s = run(p, scene, images, known, normal);
    nn_program_free(p);
    return s;
}
