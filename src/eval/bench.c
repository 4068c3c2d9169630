#include "eval/bench.h"

#include <string.h>

#include "base/parallel.h"
#include "base/progress.h"
#include "base/rng.h"
#include "eval/bench_time.h"
#include "model/model.h"
#include "render/generate.h"

double bench_training_peak(const nn_peak *peak)
{
    return 3 / (1 / peak->forward + 1 / peak->backward_data + 1 / peak->backward_weights);
}

static status measure_copy(const bench_options *o, bench_report *out)
{
    return bench_copy_rate(bench_patience_of(o->quick), &out->copy_rate);
}

typedef struct network_work {
    nn_graph *graph;
    nn_params *params;
    nn_program *program;
    nn_adam *adam; /* NULL: inference */
} network_work;

static status run_network(void *context)
{
    const network_work *w = context;
    status s = nn_forward(w->program);
    if (s != OK || !w->adam) return s;
    s = nn_backward(w->program);
    /* a rate of zero: the same work, and the parameters stay what they are from run to run */
    return s == OK ? nn_adam_step(w->adam, 0) : s;
}

/* Something that looks like data: noise in the pictures, and everything inside the mask. */
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

static status use_network(const char *weights, const nn_options *options, network_work *w)
{
    model_config config;
    status s = model_load(weights, &config, &w->params);
    if (s == OK) s = model_build(&config, MODEL_WHOLE, &w->graph);
    return s == OK ? nn_compile(w->graph, w->params, options, &w->program) : s;
}

static status train_network(const char *weights, const nn_options *options, network_work *w)
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

/* Behind a line that says what ran: the program's steps, the best time of each (nn_profile). */
static status profile_network(const bench_options *o, const nn_options *options, nn_program *program)
{
    const char *type = options->type == NN_BFLOAT16 ? "bfloat16" : "float32";
    const char *what = options->purpose == NN_TRAIN ? "training" : "inference";
    int written =
        fprintf(o->profile, "%s, %d of %dx%d, %s\n", what, options->batch, options->width, options->height, type);
    return written > 0 ? nn_profile(program, o->quick ? 2 : 10, o->profile)
                       : fail(ERROR_OUTPUT, "cannot write the profile");
}

static status measure_network(const bench_options *o, const char *weights, const nn_options *options, double peak,
                              bench_network *out)
{
    network_work w = {0};
    bench_reset_resident();
    status s = options->purpose == NN_TRAIN ? train_network(weights, options, &w) : use_network(weights, options, &w);
    if (s == OK) {
        fill_inputs(w.program, (size_t)options->batch * (size_t)options->height * (size_t)options->width);
        s = bench_time(run_network, &w, bench_patience_of(o->quick), &out->seconds);
    }
    if (s == OK) {
        nn_cost cost = nn_program_cost(w.program);
        out->flops = cost.forward_flops + (w.adam ? cost.backward_flops : 0);
        out->bytes = cost.activation_bytes + cost.workspace_bytes + cost.parameter_bytes;
        out->share = out->flops / out->seconds / peak;
        out->resident_bytes = bench_peak_resident();
    }
    if (s == OK && o->profile) s = profile_network(o, options, w.program);
    nn_adam_free(w.adam);
    nn_program_free(w.program);
    nn_graph_free(w.graph);
    nn_params_free(w.params);
    return s;
}

static status measure_type(const bench_options *o, nn_type type, bench_report *out)
{
    status s = nn_measure_peak(type, &out->peak[type]);
    if (s == ERROR_DEVICE && type != NN_FLOAT32) return OK; /* this processor does without */
    if (s != OK) return s;
    out->measured[type] = true;
    nn_options infer = {
        .batch = 1, .height = BENCH_INFERENCE_SIZE, .width = BENCH_INFERENCE_SIZE, .type = type, .purpose = NN_INFER};
    nn_options train = {.batch = out->batch,
                        .height = BENCH_TRAINING_SIZE,
                        .width = BENCH_TRAINING_SIZE,
                        .type = type,
                        .purpose = NN_TRAIN};
    s = measure_network(o, o->weights, &infer, out->peak[type].forward, &out->inference[type]);
    if (s != OK) return s;
    return measure_network(o, o->weights, &train, bench_training_peak(&out->peak[type]), &out->training[type]);
}

static status measure_float32(const bench_options *o, bench_report *out)
{
    return measure_type(o, NN_FLOAT32, out);
}

static status measure_bfloat16(const bench_options *o, bench_report *out)
{
    return measure_type(o, NN_BFLOAT16, out);
}

/* A few samples tell how many fill the time. */
static status measure_rendering(const bench_options *o, bench_report *out)
{
    render_options options = render_options_default();
    render_stats stats;
    options.quiet = true;
    options.interrupted = o->stopped;
    options.count = 2 * (size_t)parallel_threads();
    status s = render_samples(&options, &stats);
    if (s != OK) return s;
    double wanted = (o->quick ? 2 : 10) * (double)stats.rendered / stats.seconds;
    options.first = options.count;
    options.count = wanted > 4 ? (size_t)wanted : 4;
    s = render_samples(&options, &stats);
    out->samples = stats.rendered;
    out->render_seconds = stats.seconds;
    out->rays = stats.rays;
    return s;
}

static status measure_estimate(const bench_options *o, bench_report *out)
{
    return bench_estimate(o->program, o->weights, o->quick ? 2 : 7, &out->estimate);
}

static status measure_relight(const bench_options *o, bench_report *out)
{
    return bench_relight(o->weights, bench_patience_of(o->quick), &out->relight);
}

static status read_name(const bench_options *o, bench_report *out)
{
    model_config config;
    status s = model_load_config(o->weights, &config);
    if (s == OK) memcpy(out->model, config.name, sizeof out->model);
    return s;
}

status bench_run(const bench_options *options, bench_report *out)
{
    static const struct {
        status (*measure)(const bench_options *o, bench_report *out);
        const char *what;
    } stages[] = {{read_name, "weights"},          {measure_estimate, "estimate"}, {measure_copy, "copying"},
                  {measure_float32, "float32"},    {measure_bfloat16, "bfloat16"}, {measure_relight, "relighting"},
                  {measure_rendering, "rendering"}};
    enum { STAGES = sizeof stages / sizeof stages[0] };
    *out = (bench_report){.threads = parallel_threads(), .batch = options->batch ? options->batch : 16};
    progress p;
    progress_begin(&p, "measuring", "stages", 0, STAGES, options->quiet);
    status s = OK;
    for (size_t i = 0; s == OK && i < STAGES; i++) {
        progress_update(&p, i, stages[i].what);
        if (options->stopped && options->stopped())
            s = fail(ERROR_STOPPED, "stopped before measuring %s", stages[i].what);
        else
            s = stages[i].measure(options, out);
        /* Ctrl-C goes to the programs that a stage starts, too, and they fail */
        if (s != OK && options->stopped && options->stopped())
            s = fail(ERROR_STOPPED, "stopped while measuring %s", stages[i].what);
    }
    if (s == OK) progress_update(&p, STAGES, NULL);
    progress_end(&p);
    return s;
}
