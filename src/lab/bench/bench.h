/* SPDX-License-Identifier: MIT */
/* Measures the cost of model, estimate and renderer on this machine, as shares of its peak.
 *
 *     bench_options options = {.weights = "weights.safetensors", .program = "/usr/bin/merlin"};
 *     bench_report report;
 *     status s = bench_run(&options, &report);
 *     if (s == OK) bench_print_table(&report, stdout);
 *
 * Times are medians. Rates count only convolutions and fully connected layers, 2 operations a multiply-add, so that a
 * share of the peak is the share of the time that they would need at best. */
#ifndef MERLIN_LAB_BENCH_BENCH_H
#define MERLIN_LAB_BENCH_BENCH_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "lab/bench/bench_estimate.h"
#include "lab/bench/bench_relight.h"
#include "nn/nn.h"

enum { BENCH_TYPES = 2, BENCH_INFERENCE_SIZE = 256, BENCH_TRAINING_SIZE = 128 };

typedef struct bench_network {
    double seconds;
    double flops;          /* of one run */
    double share;          /* flops / seconds over the machine's peak */
    size_t bytes;          /* planned: parameters, activations, workspace */
    size_t resident_bytes; /* peak memory of this process while it ran; 0 if the system does not tell */
} bench_network;

typedef struct bench_report {
    char model[64];
    int threads, batch;
    double copy_rate;                     /* bytes read and written a second by memcpy on all threads */
    bool measured[BENCH_TYPES];           /* false: the processor does not compute in this type */
    nn_peak peak[BENCH_TYPES];            /* by nn_type */
    bench_network inference[BENCH_TYPES]; /* for a picture of 256×256 */
    bench_network training[BENCH_TYPES];  /* forward, backward and Adam for `batch` pictures of 128×128 */
    bench_estimation estimate;            /* for a picture of 256×256 */
    bench_relighting relight;             /* of that picture */
    size_t samples;                       /* samples rendered, 128×128 */
    double render_seconds;
    uint64_t rays;
} bench_report;

typedef struct bench_options {
    const char *weights;
    const char *program; /* path of merlin itself, to be run as `estimate` */
    int batch;           /* of training; 0: 16 */
    bool quick;          /* fewer runs */
    bool quiet;
    int (*stopped)(void); /* polled between measurements; NULL: never */
} bench_options;

status bench_run(const bench_options *options, bench_report *out);

void bench_print_table(const bench_report *report, FILE *stream);
/* Returns malloc'ed JSON; NULL if memory ran out. */
char *bench_report_json(const bench_report *report);

#endif
