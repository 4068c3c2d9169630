/* SPDX-License-Identifier: MIT */
#include "lab/bench/bench.h"

#include <string.h>

#include "base/parallel.h"
#include "base/progress.h"
#include "lab/bench/bench_network.h"
#include "lab/bench/bench_time.h"
#include "lab/render/generate.h"
#include "model/model.h"

static status measure_copy(const bench_options *o, bench_report *out)
{
    return bench_copy_rate(bench_budget_of(o->quick), &out->copy_rate);
}

static status measure_network(const bench_options *o, const char *weights, const nn_options *options, double peak,
                              bench_network *out)
{
    bench_program w;
    bench_reset_resident();
    status s = bench_program_new(weights, options, &w);
    if (s == OK) s = bench_time(bench_program_run, &w, bench_budget_of(o->quick), &out->seconds);
    if (s == OK) {
        nn_cost cost = nn_program_cost(w.program);
        out->flops = cost.forward_flops + (w.adam ? cost.backward_flops : 0);
        out->bytes = cost.activation_bytes + cost.workspace_bytes + cost.parameter_bytes;
        out->share = out->flops / out->seconds / peak;
        out->resident_bytes = bench_peak_resident();
    }
    bench_program_free(&w);
    return s;
}

static status measure_type(const bench_options *o, nn_type type, bench_report *out)
{
    status s = nn_measure_peak(type, &out->peak[type]);
    if (s == MERLIN_DEVICE_FAILED && type != NN_FLOAT32) return OK; /* this processor does not compute in it */
    if (s != OK) return s;
    out->measured[type] = true;
    nn_options infer = {
        .batch = 1, .height = BENCH_INFERENCE_SIZE, .width = BENCH_INFERENCE_SIZE, .type = type, .purpose = NN_INFER};
    nn_options train = {.batch = out->batch,
                        .height = BENCH_TRAINING_SIZE,
                        .width = BENCH_TRAINING_SIZE,
                        .type = type,
                        .purpose = NN_TRAIN};
    s = measure_network(o, o->weights, &infer, bench_peak_for(&out->peak[type], NN_INFER), &out->inference[type]);
    if (s != OK) return s;
    return measure_network(o, o->weights, &train, bench_peak_for(&out->peak[type], NN_TRAIN), &out->training[type]);
}

static status measure_float32(const bench_options *o, bench_report *out)
{
    return measure_type(o, NN_FLOAT32, out);
}

static status measure_bfloat16(const bench_options *o, bench_report *out)
{
    return measure_type(o, NN_BFLOAT16, out);
}

/* Measures rendering; a few samples first tell how many fill the time. */
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
    return bench_relight(o->weights, bench_budget_of(o->quick), &out->relight);
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
            s = fail(MERLIN_STOPPED, "stopped before measuring %s", stages[i].what);
        else
            s = stages[i].measure(options, out);
        /* Ctrl-C also reaches the programs that were started, which then fail */
        if (s != OK && options->stopped && options->stopped())
            s = fail(MERLIN_STOPPED, "stopped while measuring %s", stages[i].what);
    }
    if (s == OK) progress_update(&p, STAGES, NULL);
    progress_end(&p);
    return s;
}
