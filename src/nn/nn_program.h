/* SPDX-License-Identifier: MIT */
/* A compiled program: a flat list of steps over one arena. Internal to src/nn. */
#ifndef MERLIN_NN_NN_PROGRAM_H
#define MERLIN_NN_NN_PROGRAM_H

#include "nn/device.h"

typedef struct program_port {
    char *name;
    nn_tensor device; /* where the program reads or leaves it */
    float *host;      /* what the caller sees; the same memory where types agree */
    bool owned;       /* host was allocated for this port */
} program_port;

/* Activations and scratch, of one program or of several that never run at once. */
typedef struct program_arena {
    void *memory;
    size_t bytes;
    int users;
} program_arena;

struct nn_program {
    const nn_device *device;
    void *context;
    nn_params *params;
    nn_options options;
    nn_step *steps; /* in forward order */
    int step_count;
    program_port *inputs, *outputs;
    int input_count, output_count;
    program_arena *arena;
    size_t arena_bytes, own_bytes; /* of the arena: what this program needs */
    uint64_t version;              /* of the parameters that the steps hold converted copies of */
    bool *untouched;               /* per parameter: no step writes its gradient */
    bool forwarded;
};

/* The step's own copies of its parameters as they are now. */
status program_refresh_step(nn_step *step);

#endif
