/* SPDX-License-Identifier: MIT */
/* A device is a table of functions; a step is what the compiler asks a device to compute.
 *
 * The compiler describes a step (operation, shapes, fused operations, parameters); the device reads it once in
 * `create`, states how much memory it needs beside its tensors, and later runs it. Models and compiler do not depend on
 * a device; a device does not depend on graphs. Internal to src/nn. */
#ifndef MERLIN_NN_DEVICE_H
#define MERLIN_NN_DEVICE_H

#include "nn/adam_step.h"
#include "nn/graph.h"
#include "nn/params.h"
#include "nn/tensor.h"

typedef struct nn_step nn_step;

typedef struct step_functions {
    status (*bind)(nn_step *step);    /* called once, when all memory has its address; may be NULL */
    status (*refresh)(nn_step *step); /* called after parameters changed; may be NULL */
    status (*forward)(nn_step *step);
    status (*backward)(nn_step *step); /* gradients of out to gradients of in and parameters */
    void (*release)(nn_step *step);    /* frees step->state; may be NULL */
} step_functions;

struct nn_step {
    /* the compiler's description: */
    nn_op op;
    char *name;
    nn_attributes at;
    nn_type compute; /* type in which convolutions are computed */
    nn_filtering filtering;
    bool train, relu; /* relu: applied to the result */
    bool backs;       /* has a backward pass */
    int group;        /* pictures of each object */
    float momentum;   /* for batch norm's running statistics */
    int inputs;       /* 2 for a convolution without training to whose result the second input is added before ReLU */
    nn_tensor in[NN_MAX_INPUTS], out;
    nn_tensor in_gradient[NN_MAX_INPUTS], out_gradient; /* data NULL: not needed */
    bool wants[NN_MAX_INPUTS];                          /* inputs whose gradients are needed (before data is known) */
    bool accumulate[NN_MAX_INPUTS];                     /* add to in_gradient instead of writing it */
    node_params params, folded; /* folded: batch norm to fold into a convolution; weight NULL: none */

    void *context;         /* the device's, shared by a program's steps */
    const ranks *together; /* as in nn_options */

    /* filled in by the device's create: */
    const step_functions *run;
    void *state;
    bool reads_in, reads_out;                 /* whether backward reads in and out, which are then kept */
    size_t forward_scratch, backward_scratch; /* bytes used during one call */
    size_t own_bytes;                         /* bytes held by state: converted weights and the like */
    double forward_flops, backward_flops;

    /* memory, assigned before bind: */
    void *forward_space, *backward_space;

    /* result of a loss: */
    float loss;
    double mask_sum;
};

/* A device. Memory that it allocates must be addressable by the host. */
typedef struct nn_device {
    nn_type (*usable_type)(nn_type wanted); /* returns `wanted`, or float32 if the device cannot compute in it */
    nn_type (*fastest_type)(void);
    status (*open)(void **context);
    void (*close)(void *context);
    status (*create)(nn_step *step);
    void *(*allocate)(size_t bytes); /* returns zeroed memory, aligned to 64 */
    void (*release)(void *memory);
    void (*begin)(void *context); /* called before and after the steps of a run */
    void (*end)(void *context);
    void (*convert)(const nn_tensor *from, nn_tensor *to); /* converts an output to float32 */
    /* Parts of the optimizer, on the floats of one parameter. */
    void (*adam)(const adam_step *step, size_t count, float *value, const float *gradient, float *moment1,
                 float *moment2);
    double (*sum_squares)(const float *x, size_t count); /* returns NaN or infinity if any element is */
    status (*measure_peak)(void *context, nn_type type, nn_peak *out);
} nn_device;

const nn_device *cpu_device(void);

#endif
