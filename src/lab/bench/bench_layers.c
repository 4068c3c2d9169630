/* SPDX-License-Identifier: MIT */
#include "lab/bench/bench_layers.h"

#include <cjson/cJSON.h>
#include <stdlib.h>
#include <string.h>

#include "base/json/json_put.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/text/report.h"
#include "lab/bench/bench.h"
#include "lab/bench/bench_network.h"
#include "model/model.h"

static status keep(void *context, const nn_layer *layer)
{
    bench_layer_run *run = context;
    /* inference converts its parameters only once, before the first picture */
    if (run->options.purpose == NN_INFER && strcmp(layer->pass, "refresh") == 0) return OK;
    bench_layer *more = realloc(run->layer, (run->count + 1) * sizeof *more);
    if (!more) return fail(MERLIN_NO_MEMORY, "no memory for the times of %zu layers", run->count + 1);
    run->layer = more;
    bench_layer *l = &more[run->count++];
    *l = (bench_layer){
        .n = layer->n, .h = layer->h, .w = layer->w, .c = layer->c, .seconds = layer->seconds, .flops = layer->flops};
    snprintf(l->pass, sizeof l->pass, "%s", layer->pass);
    snprintf(l->operation, sizeof l->operation, "%s", layer->operation);
    snprintf(l->name, sizeof l->name, "%s", layer->name);
    run->seconds += layer->seconds;
    return OK;
}

static int slower_first(const void *a, const void *b)
{
    const bench_layer *x = a, *y = b;
    return (x->seconds < y->seconds) - (x->seconds > y->seconds);
}

static status measure_once(const bench_layers_options *o, bench_layer_run *run, nn_filtering filtering)
{
    bench_program work;
    run->options.filtering = filtering;
    status s = bench_program_new(o->weights, &run->options, &work);
    if (s == OK) s = nn_measure_layers(work.program, o->quick ? 2 : 10, keep, run);
    bench_program_free(&work);
    return s;
}

/* Measures the same layers computed by the other algorithms. */
static status measure_ways(const bench_layers_options *o, bench_layer_run *run)
{
    for (int all = 0; all <= 1; all++) {
        bench_layer_run way = {.options = run->options};
        status s = measure_once(o, &way, all ? NN_FILTER_ALL : NN_FILTER_NONE);
        for (size_t i = 0; i < run->count && i < way.count && s == OK; i++)
            *(all ? &run->layer[i].filtered : &run->layer[i].summed) = way.layer[i].seconds;
        free(way.layer);
        if (s != OK) return s;
    }
    return OK;
}

static status measure_run(const bench_layers_options *o, const nn_options *options, const nn_peak *peak,
                          bench_layers *out)
{
    bench_layer_run *run = &out->run[out->runs++];
    *run = (bench_layer_run){.options = *options, .peak = bench_peak_for(peak, options->purpose)};
    status s = measure_once(o, run, NN_FILTER_FASTER);
    if (s == OK) s = measure_ways(o, run);
    if (s == OK) qsort(run->layer, run->count, sizeof *run->layer, slower_first);
    return s;
}

static status measure_type(const bench_layers_options *o, nn_type type, progress *p, bench_layers *out)
{
    nn_peak peak;
    status s = nn_measure_peak(type, &peak);
    if (s == MERLIN_DEVICE_FAILED && type != NN_FLOAT32) return OK; /* this processor does not compute in it */
    const nn_options kinds[] = {
        {.batch = 1, .height = BENCH_INFERENCE_SIZE, .width = BENCH_INFERENCE_SIZE, .type = type, .purpose = NN_INFER},
        {.batch = o->batch ? o->batch : 16,
         .height = BENCH_TRAINING_SIZE,
         .width = BENCH_TRAINING_SIZE,
         .type = type,
         .purpose = NN_TRAIN}};
    for (size_t i = 0; s == OK && i < sizeof kinds / sizeof *kinds; i++) {
        progress_update(p, (uint64_t)out->runs, bench_type_name(type));
        if (o->stopped && o->stopped()) return fail(MERLIN_STOPPED, "stopped while measuring layers");
        s = measure_run(o, &kinds[i], &peak, out);
    }
    return s;
}

status bench_layers_measure(const bench_layers_options *options, bench_layers *out)
{
    *out = (bench_layers){.threads = parallel_threads()};
    model_config config;
    status s = model_load_config(options->weights, &config);
    if (s != OK) return s;
    memcpy(out->model, config.name, sizeof out->model);
    progress p;
    progress_begin(&p, "measuring layers", "runs", 0, BENCH_LAYER_RUNS, options->quiet);
    s = measure_type(options, NN_FLOAT32, &p, out);
    if (s == OK) s = measure_type(options, NN_BFLOAT16, &p, out);
    progress_end(&p);
    return s;
}

void bench_layers_free(bench_layers *layers)
{
    for (int i = 0; i < layers->runs; i++)
        free(layers->run[i].layer);
}

static const char *purpose_name(const bench_layer_run *run)
{
    return run->options.purpose == NN_TRAIN ? "training step" : "inference";
}

static double share_of_peak(const bench_layer_run *run, const bench_layer *l)
{
    return l->seconds > 0 ? l->flops / l->seconds / run->peak : 0;
}

static void print_run(const bench_layer_run *run, FILE *stream)
{
    const nn_options *o = &run->options;
    fprintf(stream, "\n%s, %d of %dx%d, %s: %.1f ms in %zu steps, peak %.0f GFLOP/s\n", purpose_name(run), o->batch,
            o->width, o->height, bench_type_name(o->type), run->seconds * 1e3, run->count, run->peak * 1e-9);
    fprintf(stream, "%-9s%-18s %-39s %-17s%9s%9s%9s%10s%9s%10s%9s\n", "pass", "operation", "name", "result", "ms",
            "of time", "GFLOP", "GFLOP/s", "of peak", "filtered", "summed");
    for (size_t i = 0; i < run->count; i++) {
        const bench_layer *l = &run->layer[i];
        char shape[64];
        snprintf(shape, sizeof shape, "%dx%dx%dx%d", l->n, l->h, l->w, l->c);
        fprintf(stream, "%-9s%-18s %-39s %-17s%9.3f%7.1f %%", l->pass, l->operation, l->name, shape, l->seconds * 1e3,
                100 * l->seconds / run->seconds);
        if (l->flops > 0)
            fprintf(stream, "%9.3f%10.0f%7.0f %%", l->flops * 1e-9, l->flops / l->seconds * 1e-9,
                    100 * share_of_peak(run, l));
        if (l->flops > 0) fprintf(stream, "%10.3f%9.3f", l->filtered * 1e3, l->summed * 1e3);
        fputc('\n', stream);
    }
}

void bench_layers_print(const bench_layers *layers, FILE *stream)
{
    fprintf(stream, "%s, %d threads: the best time of every layer, slowest first\n", layers->model, layers->threads);
    for (int i = 0; i < layers->runs; i++)
        print_run(&layers->run[i], stream);
}

static void add_layer(cJSON *parent, const bench_layer_run *run, const bench_layer *l)
{
    cJSON *o = json_append_object(parent);
    json_put_text(o, "pass", l->pass);
    json_put_text(o, "operation", l->operation);
    json_put_text(o, "name", l->name);
    const int shape[] = {l->n, l->h, l->w, l->c};
    json_put_item(o, "shape", cJSON_CreateIntArray(shape, 4));
    json_put_number(o, "seconds", l->seconds);
    json_put_number(o, "gflop", l->flops * 1e-9);
    json_put_number(o, "share_of_peak", share_of_peak(run, l));
    json_put_number(o, "filtered", l->filtered);
    json_put_number(o, "summed", l->summed);
}

char *bench_layers_json(const bench_layers *layers)
{
    cJSON *o = report_begin(&(warnings){0});
    json_put_text(o, "model", layers->model);
    json_put_number(o, "threads", layers->threads);
    cJSON *runs = json_put_array(o, "runs");
    for (int i = 0; i < layers->runs; i++) {
        const bench_layer_run *run = &layers->run[i];
        cJSON *one = json_append_object(runs);
        json_put_text(one, "purpose", run->options.purpose == NN_TRAIN ? "training" : "inference");
        json_put_text(one, "type", bench_type_name(run->options.type));
        json_put_number(one, "batch", run->options.batch);
        json_put_number(one, "size", run->options.width);
        json_put_number(one, "peak", run->peak * 1e-9);
        json_put_number(one, "seconds", run->seconds);
        cJSON *list = json_put_array(one, "layers");
        for (size_t k = 0; k < run->count; k++)
            add_layer(list, run, &run->layer[k]);
    }
    char *text = json_print(o);
    cJSON_Delete(o);
    return text;
}
