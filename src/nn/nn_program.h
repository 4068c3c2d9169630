/* SPDX-License-Identifier: MIT */
/* A compiled program: a flat list of steps over one arena. Internal to src/nn. */
#ifndef MERLIN_NN_NN_PROGRAM_H
#define MERLIN_NN_NN_PROGRAM_H

#include "nn/device.h"

typedef struct program_port {
    char *name;
    nn_tensor device; /* where the program reads or writes it */
    float *host;      /* the caller's buffer; the same memory if the types are equal */
    bool owned;       /* host was allocated for this port */
} program_port;

/* Activations and scratch memory, of one program or of several that never run at the same time. */
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
    size_t arena_bytes, own_bytes; /* arena_bytes: what this program needs of the arena */
    uint64_t version;              /* version of the parameters whose converted copies the steps hold */
    bool *untouched;               /* per parameter: no step writes its gradient */
    bool forwarded;
};

/* Updates the step's own copies of its parameters. */
status program_refresh_step(nn_step *step);

#endif
