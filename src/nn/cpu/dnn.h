/* Short words for oneDNN: statuses with messages, channels-last descriptors, a primitive with its arguments.
 * Internal to src/nn/cpu. */
#ifndef MERLIN_NN_CPU_DNN_H
#define MERLIN_NN_CPU_DNN_H

#include <oneapi/dnnl/dnnl.h>

#include "nn/device.h"

typedef struct dnn_context {
    dnnl_engine_t engine;
    dnnl_stream_t stream;
    unsigned control; /* the calling thread's floating-point mode before a run */
} dnn_context;

status dnn_open(void **context);
void dnn_close(void *context);

/* OK, or ERROR_DEVICE with "oneDNN: what: reason". */
status dnn_check(dnnl_status_t code, const char *what);

/* Channels-last memory of a tensor's shape in a type. */
dnnl_memory_desc_t dnn_activation(const nn_tensor *t, nn_type type);
dnnl_data_type_t dnn_type(nn_type type);

enum { DNN_MAX_ARGUMENTS = 6 };

/* A primitive and what it is called with; owns both. Zero-initialized is empty. */
typedef struct dnn_call {
    dnnl_primitive_desc_t description;
    dnnl_primitive_t primitive;
    dnnl_exec_arg_t arguments[DNN_MAX_ARGUMENTS];
    int count;
} dnn_call;

/* Describes a primitive from an operation descriptor; relu is a post-operation; hint a forward description or NULL. */
status dnn_describe(dnn_call *call, const dnn_context *context, const void *descriptor, bool relu,
                    const dnn_call *hint);
/* The same without ReLU, by the first implementation whose name does not have `avoided` in it. */
status dnn_describe_otherwise(dnn_call *call, const dnn_context *context, const void *descriptor, const char *avoided,
                              const dnn_call *hint);
size_t dnn_scratch_bytes(const dnn_call *call);
const dnnl_memory_desc_t *dnn_query(const dnn_call *call, dnnl_query_t what);
/* Adds an argument that lies at data. */
status dnn_argument(dnn_call *call, const dnn_context *context, int kind, const dnnl_memory_desc_t *layout, void *data);
/* Makes the primitive from its description. */
status dnn_make(dnn_call *call, void *scratch, const dnn_context *context);
/* A call that copies with change of layout and type. */
status dnn_make_reorder(dnn_call *call, const dnn_context *context, const dnnl_memory_desc_t *from, void *source,
                        const dnnl_memory_desc_t *to, void *target);
status dnn_run(const dnn_call *call, const dnn_context *context);
void dnn_release(dnn_call *call);

#endif
