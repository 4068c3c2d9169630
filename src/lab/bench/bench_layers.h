/* SPDX-License-Identifier: MIT */
/* Measures the network layer by layer, slowest first: inference of one picture and a training step, in every precision
 * that the processor computes in.
 *
 *     bench_layers layers;
 *     status s = bench_layers_measure(&(bench_layers_options){.weights = "weights.safetensors"}, &layers);
 *     if (s == OK) bench_layers_print(&layers, stdout);
 *     bench_layers_free(&layers);
 */
#ifndef MERLIN_LAB_BENCH_BENCH_LAYERS_H
#define MERLIN_LAB_BENCH_BENCH_LAYERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "nn/nn.h"

enum { BENCH_LAYER_RUNS = 4 };

typedef struct bench_layer {
    char pass[16], operation[32], name[64];
    int n, h, w, c; /* shape of the result */
    double seconds; /* of the best run */
    double flops;
    double filtered, summed; /* seconds with Winograd's filtering wherever it is possible, and without it */
} bench_layer;

typedef struct bench_layer_run {
    nn_options options; /* what was run: purpose, precision and size */
    double peak;        /* FLOP/s, bench_peak_for */
    double seconds;     /* of all layers */
    bench_layer *layer; /* slowest first */
    size_t count;
} bench_layer_run;

typedef struct bench_layers {
    char model[64];
    int threads;
    bench_layer_run run[BENCH_LAYER_RUNS];
    int runs;
} bench_layers;

typedef struct bench_layers_options {
    const char *weights;
    int batch; /* of training; 0: 16 */
    bool quick, quiet;
    int (*stopped)(void); /* polled between measurements; NULL: never */
} bench_layers_options;

/* Measures the layers. *out must be freed in any case. */
status bench_layers_measure(const bench_layers_options *options, bench_layers *out);
void bench_layers_free(bench_layers *layers);

void bench_layers_print(const bench_layers *layers, FILE *stream);
/* Returns malloc'ed JSON; NULL if memory ran out. */
char *bench_layers_json(const bench_layers *layers);

#endif
