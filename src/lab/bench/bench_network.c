/* SPDX-License-Identifier: MIT */
#include "lab/bench/bench_network.h"

#include "base/rng.h"
#include "model/model.h"

status bench_program_run(void *work)
{
    const bench_program *w = work;
    status s = nn_forward(w->program);
    if (s != OK || !w->adam) return s;
    s = nn_backward(w->program);
    /* a rate of zero: the same work, and the parameters stay the same from run to run */
    return s == OK ? nn_adam_step(w->adam, 0) : s;
}

/* Fills the inputs with data of realistic statistics: noise in the pictures, and everything inside the mask. */
static void fill_inputs(nn_program *p, size_t pixels)
{
    static const struct {
        const char *name;
        int channels;
        float low, high;
    } inputs[] = {{"image", 3, 0, 1},
                  {"mask", 1, 1, 1},
                  {"loss_mask", 1, 1, 1},
                  {"albedo_true", 3, -1, 1},
                  {"normal_true", 3, 0, 1},
                  {"depth_true", 1, 0.8f, 1},
                  {"roughness_true", 1, -1, 1},
                  {"direct_true", 3, 0, 1},
                  {"indirect_true", 3, 0, 0.1f},
                  {"reconstruction_true", 3, 0, 1},
                  {"relit_true", 3, 0, 1}};
    rng r = rng_at(1, 0, 0);
    for (size_t k = 0; k < sizeof inputs / sizeof inputs[0]; k++) {
        float *data = nn_input_data(p, inputs[k].name);
        if (!data) continue;
        for (size_t i = 0; i < pixels * (size_t)inputs[k].channels; i++)
            data[i] = rng_range(&r, inputs[k].low, inputs[k].high);
    }
}

static status use_network(const char *weights, const nn_options *options, bench_program *w)
{
    model_config config;
    status s = model_load(weights, &config, &w->params);
    if (s == OK) s = model_build(&config, MODEL_WHOLE, &w->graph);
    return s == OK ? nn_compile(w->graph, w->params, options, &w->program) : s;
}

static status train_network(const char *weights, const nn_options *options, bench_program *w)
{
    model_config config;
    status s = model_load_config(weights, &config);
    if (s == OK) s = model_build(&config, MODEL_TRAINING, &w->graph);
    if (s == OK) s = nn_params_new(w->graph, 0, &w->params);
    if (s == OK) s = nn_params_load(w->params, weights);
    if (s == OK) s = nn_compile(w->graph, w->params, options, &w->program);
    if (s != OK) return s;
    return nn_adam_new(w->params, &(nn_adam_options){.beta1 = 0.9f, .beta2 = 0.999f, .epsilon = 1e-8f}, &w->adam);
}

status bench_program_new(const char *weights, const nn_options *options, bench_program *out)
{
    *out = (bench_program){0};
    status s = options->purpose == NN_TRAIN ? train_network(weights, options, out) : use_network(weights, options, out);
    if (s == OK) fill_inputs(out->program, (size_t)options->batch * (size_t)options->height * (size_t)options->width);
    return s;
}

void bench_program_free(bench_program *work)
{
    nn_adam_free(work->adam);
    nn_program_free(work->program);
    nn_graph_free(work->graph);
    nn_params_free(work->params);
}

const char *bench_type_name(nn_type type)
{
    return type == NN_BFLOAT16 ? "bfloat16" : "float32";
}

double bench_peak_for(const nn_peak *peak, nn_purpose purpose)
{
    if (purpose != NN_TRAIN) return peak->forward;
    return 3 / (1 / peak->forward + 1 / peak->backward_data + 1 / peak->backward_weights);
}
