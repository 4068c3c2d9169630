/* SPDX-License-Identifier: MIT */
/* A device as a table of functions, and a step as what the compiler asks a device to compute.
 *
 * The compiler describes a step (operation, shapes, what is fused into it, parameters); the device looks at it once in
 * `create`, says how much memory it needs beside its tensors, and later runs it. Models and compiler know nothing of a
 * device; a device knows nothing of graphs. Internal to src/nn. */
#ifndef MERLIN_NN_DEVICE_H
#define MERLIN_NN_DEVICE_H

#include "nn/adam_step.h"
#include "nn/graph.h"
#include "nn/params.h"
#include "nn/tensor.h"

typedef struct nn_step nn_step;

typedef struct step_functions {
    status (*bind)(nn_step *step);    /* once, when all memory has its address; may be NULL */
    status (*refresh)(nn_step *step); /* after parameters changed; may be NULL */
    status (*forward)(nn_step *step);
    status (*backward)(nn_step *step); /* gradients of out to gradients of in and parameters */
    void (*release)(nn_step *step);    /* frees step->state; may be NULL */
} step_functions;

struct nn_step {
    /* what to compute: the compiler's words */
    nn_op op;
    char *name;
    nn_attributes at;
    nn_type compute; /* the type convolutions run in */
    nn_filtering filtering;
    bool train, relu; /* relu: applied to the result */
    bool backs;       /* has a backward pass */
    float momentum;   /* of batch norm's running statistics */
    int inputs;       /* of a convolution that is not trained 2 where the second is added to the result, before relu */
    nn_tensor in[NN_MAX_INPUTS], out;
    nn_tensor in_gradient[NN_MAX_INPUTS], out_gradient; /* data NULL: none is wanted */
    bool wants[NN_MAX_INPUTS];                          /* which inputs' gradients are wanted (before data is known) */
    bool accumulate[NN_MAX_INPUTS];                     /* add to in_gradient instead of writing it */
    node_params params, folded; /* folded: batch norm by running statistics behind a convolution, weight NULL if none */

    void *context;         /* of the device, shared by a program's steps */
    const ranks *together; /* nn_options' */

    /* the device's answers from create */
    const step_functions *run;
    void *state;
    bool reads_in, reads_out;                 /* whether backward reads in and out, which are kept for it */
    size_t forward_scratch, backward_scratch; /* for the time of one call */
    size_t own_bytes;                         /* held by state: converted weights and the like */
    double forward_flops, backward_flops;

    /* memory, given before bind */
    void *forward_space, *backward_space;

    /* results of losses */
    float loss;
    double mask_sum;
};

/* Memory that a device allocates must be addressable by the host. */
typedef struct nn_device {
    nn_type (*usable_type)(nn_type wanted); /* wanted, or float32 where the device cannot compute in it */
    nn_type (*fastest_type)(void);
    status (*open)(void **context);
    void (*close)(void *context);
    status (*create)(nn_step *step);
    void *(*allocate)(size_t bytes); /* zeroed, aligned to 64 */
    void (*release)(void *memory);
    void (*begin)(void *context); /* before and after the steps of a run */
    void (*end)(void *context);
    void (*convert)(const nn_tensor *from, nn_tensor *to); /* an output to float32 */
    /* the optimizer's, on the floats of one parameter */
    void (*adam)(const adam_step *step, size_t count, float *value, const float *gradient, float *moment1,
                 float *moment2);
    double (*sum_squares)(const float *x, size_t count); /* NaN or infinity if any element is */
    status (*measure_peak)(void *context, nn_type type, nn_peak *out);
} nn_device;

const nn_device *cpu_device(void);

#endif
