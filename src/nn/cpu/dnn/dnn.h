/* SPDX-License-Identifier: MIT */
/* A small interface to oneDNN: convolutions, a primitive with its arguments. Internal to src/nn/cpu.
 *
 * Versions 2 and 3 describe memory and operations by different calls; only dnn_memory.c and dnn_describe.c distinguish
 * them. */
#ifndef MERLIN_NN_CPU_DNN_DNN_H
#define MERLIN_NN_CPU_DNN_DNN_H

#include "nn/cpu/dnn/dnn_memory.h"

typedef struct dnn_context {
    dnnl_engine_t engine;
    dnnl_stream_t stream;
    unsigned control; /* the calling thread's floating-point mode before a run */
} dnn_context;

status dnn_open(void **context);
void dnn_close(void *context);

enum { DNN_MAX_ARGUMENTS = 6, DNN_ARG_BESIDE = DNNL_ARG_ATTR_MULTIPLE_POST_OP(0) | DNNL_ARG_SRC_1 };

/* A primitive and its arguments; owns both. Zero-initialized it is empty. */
typedef struct dnn_call {
    dnnl_primitive_desc_t description;
    dnnl_primitive_t primitive;
    dnnl_exec_arg_t arguments[DNN_MAX_ARGUMENTS];
    int count;
    struct dnn_packing *packing; /* used instead of a primitive (dnn_pack.h), or NULL */
} dnn_call;

/* A convolution or one of its gradients: source, weights, bias and target are those of what `kind` computes. */
typedef struct dnn_convolution {
    dnnl_prop_kind_t kind;
    dnn_shape source, weights, bias, target, beside;
    bool has_bias;
    bool has_beside;                           /* forward only: a tensor is added, DNN_ARG_BESIDE */
    bool relu;                                 /* forward only: applied to the result */
    const char *avoided;                       /* part of the name of an implementation to be avoided, or NULL */
    const dnn_call *hint;                      /* for gradients: a forward description */
    dnnl_dims_t strides, gaps, before, behind; /* gaps: pixels between the kernel's taps */
} dnn_convolution;

status dnn_describe(dnn_call *call, const dnn_context *context, const dnn_convolution *wanted);
/* Tells whether the name of the implementation that was found has this part. */
bool dnn_is_called(const dnn_call *call, const char *part);
size_t dnn_scratch_bytes(const dnn_call *call);
dnn_layout dnn_query(const dnn_call *call, dnnl_query_t what);
/* Adds an argument whose data is at `data`. */
status dnn_argument(dnn_call *call, const dnn_context *context, int kind, dnn_layout layout, void *data);
status dnn_argument_of(dnn_call *call, const dnn_context *context, int kind, const dnn_shape *shape, void *data);
/* Makes the primitive from its description. */
status dnn_make(dnn_call *call, void *scratch, const dnn_context *context);
/* Make calls that copy float32 weights with a change of layout and type, out of or into the layout that a primitive
 * asked for. */
status dnn_make_reorder_from(dnn_call *call, const dnn_context *context, dnn_layout from, void *source,
                             const dnn_shape *to, void *target);
status dnn_make_reorder_to(dnn_call *call, const dnn_context *context, const dnn_shape *from, float *source,
                           dnn_layout to, void *target);
status dnn_run(const dnn_call *call, const dnn_context *context);
void dnn_release(dnn_call *call);

#endif
