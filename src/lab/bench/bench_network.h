/* SPDX-License-Identifier: MIT */
/* The network in the settings that `merlin-lab bench` measures: inference of one picture, or a training step with Adam.
 */
#ifndef MERLIN_LAB_BENCH_BENCH_NETWORK_H
#define MERLIN_LAB_BENCH_BENCH_NETWORK_H

#include "nn/nn.h"

typedef struct bench_program {
    nn_graph *graph;
    nn_params *params;
    nn_program *program;
    nn_adam *adam; /* NULL: inference */
} bench_program;

/* Compiles the network of these weights for options->purpose, with noise in its inputs. *out must be freed in any case.
 * Fails if the weights or the options are refused. */
status bench_program_new(const char *weights, const nn_options *options, bench_program *out);
/* Runs a bench_program once: forward, and for training backward and Adam at a rate of zero. */
status bench_program_run(void *work);
void bench_program_free(bench_program *work);

/* Returns the type's name, such as "float32". */
const char *bench_type_name(nn_type type);
/* Returns the peak for a purpose in FLOP/s: forward's or, for training, the harmonic mean of the three directions. */
double bench_peak_for(const nn_peak *peak, nn_purpose purpose);

#endif
