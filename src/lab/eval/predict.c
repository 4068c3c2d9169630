/* SPDX-License-Identifier: MIT */
#include "lab/eval/predict.h"

#include <stdlib.h>
#include <string.h>

#include "lab/eval/predict_parts.h"

enum { MOST_OUTPUTS = 8 + MODEL_FEATURES };
static const char *const estimated[] = {"albedo",   "normal",           "roughness",   "depth", "direct",
                                        "indirect", "environment_code", "environment", NULL};

/* What one of several views is asked for, and what the network's own rendering layer makes of a single one. */
static void choose_outputs(int views, const char *names[MOST_OUTPUTS + 1])
{
    const char *const *lists[] = {views == 1 ? estimated : view_outputs, model_features};
    for (int i = 0; i < 2; i++)
        for (const char *const *name = lists[i]; *name; name++)
            *names++ = *name;
    *names = NULL;
}

static status build_program(eval_model *m, model_part part, int batch, const char *const *outputs, nn_type type,
                            eval_program *p)
{
    nn_options options = {
        .batch = batch, .height = m->size, .width = m->size, .type = type, .purpose = NN_INFER, .outputs = outputs};
    status s = model_build(&m->config, part, &p->graph);
    return s == OK ? nn_compile(p->graph, m->params, &options, &p->program) : s;
}

static void free_program(eval_program *p)
{
    nn_program_free(p->program);
    nn_graph_free(p->graph);
}

static status build_programs(eval_model *m, nn_type type)
{
    bool single = m->views == 1;
    const char *outputs[MOST_OUTPUTS + 1];
    choose_outputs(m->views, outputs);
    status s = build_program(m, MODEL_MAPS, 1, outputs, type, &m->maps);
    if (s == OK && eval_model_relights(m)) s = build_program(m, MODEL_RELIGHT, EVAL_LIGHTS, NULL, type, &m->relit);
    if (s != OK || !m->config.global_illumination) return s;
    s = build_program(m, MODEL_INDIRECT, EVAL_LIGHTS, NULL, type, &m->indirect);
    if (s == OK && !single) s = build_program(m, MODEL_INDIRECT, 1, NULL, type, &m->mean_indirect);
    return s;
}

status eval_model_open(const char *weights, int size, nn_type type, int views, eval_model **out)
{
    *out = NULL;
    if (size < MODEL_SIZE_MULTIPLE || size % MODEL_SIZE_MULTIPLE)
        return fail(MERLIN_BAD_INPUT,
                    "samples of %d pixels a side do not fit the model: the side must be a multiple of %d", size,
                    MODEL_SIZE_MULTIPLE);
    eval_model *m = calloc(1, sizeof *m);
    if (!m) return fail(MERLIN_NO_MEMORY, "no memory for a model");
    m->size = size;
    m->views = views;
    status s = model_load(weights, &m->config, &m->params);
    if (s == OK) s = build_programs(m, type);
    if (s != OK) {
        eval_model_close(m);
        return s;
    }
    *out = m;
    return OK;
}

void eval_model_close(eval_model *m)
{
    if (!m) return;
    free_program(&m->maps);
    free_program(&m->relit);
    free_program(&m->mean_indirect);
    free_program(&m->indirect);
    nn_params_free(m->params);
    free(m);
}

const model_config *eval_model_config(const eval_model *m)
{
    return &m->config;
}

bool eval_model_relights(const eval_model *m)
{
    return m->config.relight == MODEL_RELIGHT_NETWORK;
}

status eval_prediction_new(const eval_model *m, eval_prediction *out)
{
    *out = (eval_prediction){0};
    status s = eval_maps_new(&out->maps, m->size, m->size);
    if (s == OK) s = img_new(&out->flash, m->size, m->size, 3);
    if (s == OK) s = img_new(&out->indirect, m->size, m->size, 3);
    if (s == OK) s = img_new(&out->reconstruction, m->size, m->size, 3);
    for (int i = 0; i < EVAL_LIGHTS; i++) {
        if (s == OK) s = img_new(&out->by_network[i], m->size, m->size, 3);
        if (s == OK) s = img_new(&out->by_brdf[i], m->size, m->size, 3);
        if (s == OK) s = img_new(&out->full_by_network[i], m->size, m->size, 3);
        if (s == OK) s = img_new(&out->full_by_brdf[i], m->size, m->size, 3);
        if (s == OK) s = img_new(&out->shadowed[i], m->size, m->size, 3);
    }
    if (s != OK) eval_prediction_free(out);
    return s;
}

void eval_prediction_free(eval_prediction *p)
{
    eval_maps_free(&p->maps);
    img_free(&p->flash);
    img_free(&p->indirect);
    img_free(&p->reconstruction);
    for (int view = 0; view < ORIENTATIONS; view++)
        view_features_free(&p->seen[view]);
    for (int i = 0; i < EVAL_LIGHTS; i++) {
        img_free(&p->by_network[i]);
        img_free(&p->by_brdf[i]);
        img_free(&p->full_by_network[i]);
        img_free(&p->full_by_brdf[i]);
        img_free(&p->shadowed[i]);
    }
}

void eval_take(const nn_program *p, const char *name, size_t i, img *out)
{
    const float *data = nn_output_data((nn_program *)p, name);
    size_t count = (size_t)out->width * (size_t)out->height * (size_t)out->channels;
    if (data) memcpy(out->data, data + i * count, count * sizeof *data);
}

status eval_show(const eval_maps *maps, const img *mask, const illumination *light, img *out)
{
    img_free(out);
    return eval_render(maps, mask, MODEL_FOV, MODEL_LIGHT_POWER, light, out);
}
