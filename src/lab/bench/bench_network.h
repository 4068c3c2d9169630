/* SPDX-License-Identifier: MIT */
/* The network at work as `merlin-lab bench` measures it: one picture's inference, or a training step with Adam. */
#ifndef MERLIN_LAB_BENCH_BENCH_NETWORK_H
#define MERLIN_LAB_BENCH_BENCH_NETWORK_H

#include "nn/nn.h"

typedef struct bench_program {
    nn_graph *graph;
    nn_params *params;
    nn_program *program;
    nn_adam *adam; /* NULL: inference */
} bench_program;

/* Makes the network of these weights ready as options->purpose says, with something that looks like data in its
 * inputs. *out is to be freed whatever is returned: what the weights or compiling them is refused for. */
status bench_program_new(const char *weights, const nn_options *options, bench_program *out);
/* Runs a bench_program once: forward, and for training backward and Adam at a rate of zero. */
status bench_program_run(void *work);
void bench_program_free(bench_program *work);

/* "float32". */
const char *bench_type_name(nn_type type);
/* FLOP/s against which a run is held: forward's peak or, for training, the harmonic mean of the three directions. */
double bench_peak_for(const nn_peak *peak, nn_purpose purpose);

#endif
