/* SPDX-License-Identifier: MIT */
/* Writes what this project makes of a network's inputs, or how long that takes, to be held against another engine that
 * has the same network from merlin-lab export (tools/compare-onnxruntime).
 *
 *     network_values WEIGHTS maps|bounces|relight SIDE FOLDER
 *
 * writes tensors.txt, "in|out NAME N C H W" a line, and of all inputs and outputs NAME.in and NAME.out, float32 with
 * channels first, as ONNX has them. Without FOLDER: milliseconds of the best and the median of 20 runs in float32. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/progress.h"
#include "base/rng.h"
#include "estimate/photo/view.h"
#include "model/model.h"
#include "nn/graph.h"

enum { RUNS = 20, NO_PART = -1 };

typedef struct values {
    const nn_graph *graph;
    nn_program *program;
    int side;
    const char *folder;
} values;

static int height(const values *v, const nn_node *x)
{
    return x->reduction ? v->side / x->reduction : 1;
}

static FILE *open_in(const char *folder, const char *name, const char *ending)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s%s", folder, name, ending);
    FILE *f = fopen(path, "wb");
    if (f) return f;
    perror(path);
    exit(1);
}

/* Writes channels last as channels first. */
static void write_value(const values *v, FILE *list, const char *kind, const char *name, const nn_node *x,
                        const float *from)
{
    char ending[8];
    int side = height(v, x), channels = x->channels;
    snprintf(ending, sizeof ending, ".%s", kind);
    FILE *f = open_in(v->folder, name, ending);
    for (int c = 0; c < channels; c++)
        for (int i = 0; i < side * side; i++)
            fwrite(from + (size_t)i * (size_t)channels + c, sizeof *from, 1, f);
    fclose(f);
    fprintf(list, "%s %s 1 %d %d %d\n", kind, name, channels, side, side);
}

static void write_inputs(const values *v, FILE *list)
{
    for (int i = 0; i < v->graph->count; i++) {
        const nn_node *x = v->graph->nodes[i];
        if (x->op == OP_INPUT) write_value(v, list, "in", x->name, x, nn_input_data(v->program, x->name));
    }
}

static void write_outputs(const values *v, FILE *list)
{
    for (int i = 0; i < v->graph->output_count; i++) {
        const graph_output *o = &v->graph->outputs[i];
        write_value(v, list, "out", o->name, o->node, nn_output_data(v->program, o->name));
    }
}

/* Fills inputs with noise, and masks with ones. */
static void fill_inputs(const values *v)
{
    rng r = rng_at(1, 2, 3);
    for (int i = 0; i < v->graph->count; i++) {
        const nn_node *x = v->graph->nodes[i];
        float *to = x->op == OP_INPUT ? nn_input_data(v->program, x->name) : NULL;
        if (!to) continue;
        size_t count = (size_t)x->channels * (size_t)height(v, x) * (size_t)height(v, x);
        for (size_t k = 0; k < count; k++)
            to[k] = strcmp(x->name, "mask") == 0 ? 1 : rng_uniform(&r);
    }
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static status measure(nn_program *p)
{
    double ms[RUNS];
    status s = nn_forward(p);
    for (int i = 0; i < RUNS && s == OK; i++) {
        double began = clock_seconds();
        s = nn_forward(p);
        ms[i] = 1e3 * (clock_seconds() - began);
    }
    qsort(ms, RUNS, sizeof *ms, by_value);
    if (s == OK) printf("%.1f %.1f\n", ms[0], ms[RUNS / 2]);
    return s;
}

/* Inputs are written before the run, which may overwrite them. */
static status compare(const values *v)
{
    FILE *list = open_in(v->folder, "tensors", ".txt");
    write_inputs(v, list);
    status s = nn_forward(v->program);
    if (s == OK) write_outputs(v, list);
    fclose(list);
    return s;
}

static status run(const char *weights, int part, int side, const char *folder)
{
    model_config config;
    nn_params *params = NULL;
    nn_graph *g = NULL;
    nn_program *p = NULL;
    nn_options options = {.batch = 1, .height = side, .width = side, .purpose = NN_INFER};
    if (part == MODEL_MAPS && !folder) options.outputs = view_outputs; /* as the product does */
    status s = model_load(weights, &config, &params);
    if (s == OK) s = model_build(&config, (model_part)part, &g);
    if (s == OK) s = nn_compile(g, params, &options, &p);
    const values v = {g, p, side, folder};
    if (s == OK) fill_inputs(&v);
    if (s == OK) s = folder ? compare(&v) : measure(p);
    nn_program_free(p);
    nn_graph_free(g);
    nn_params_free(params);
    return s;
}

static int part_by_name(const char *name)
{
    if (strcmp(name, "maps") == 0) return MODEL_MAPS;
    if (strcmp(name, "bounces") == 0) return MODEL_INDIRECT;
    return strcmp(name, "relight") == 0 ? MODEL_RELIGHT : NO_PART;
}

int main(int argc, char **argv)
{
    int part = argc > 2 ? part_by_name(argv[2]) : NO_PART, side = argc > 3 ? atoi(argv[3]) : 0;
    if (argc < 4 || argc > 5 || part == NO_PART || side < 64 || side % MODEL_SIZE_MULTIPLE) {
        fprintf(stderr, "usage: network_values WEIGHTS maps|bounces|relight SIDE [FOLDER]\n");
        return 2;
    }
    if (run(argv[1], part, side, argc > 4 ? argv[4] : NULL) == OK) return 0;
    fprintf(stderr, "network_values: %s\n", status_message());
    return 1;
}
