/* SPDX-License-Identifier: MIT */
/* oneDNN's memory descriptions: channels-last shapes, and statuses with messages. Internal to src/nn/cpu. */
#ifndef MERLIN_NN_CPU_DNN_DNN_MEMORY_H
#define MERLIN_NN_CPU_DNN_DNN_MEMORY_H

#include <oneapi/dnnl/dnnl.h>

#include "nn/device.h"

/* Returns OK, or MERLIN_DEVICE_FAILED with "oneDNN: what: reason". */
status dnn_check(dnnl_status_t code, const char *what);

/* A tensor's sizes and type in memory; the tag gives the order of dimensions, or is dnnl_format_tag_any. */
typedef struct dnn_shape {
    int rank;
    dnnl_dims_t size;
    dnnl_data_type_t type;
    dnnl_format_tag_t tag;
} dnn_shape;

/* oneDNN's memory description as a primitive returns it, which owns it. */
#if DNNL_VERSION_MAJOR < 3
typedef const dnnl_memory_desc_t *dnn_layout;
#else
typedef const_dnnl_memory_desc_t dnn_layout;
#endif

dnnl_data_type_t dnn_type(nn_type type);
/* Returns the channels-last shape of a tensor in a type. */
dnn_shape dnn_activation(const nn_tensor *t, nn_type type);

/* Hide the differences between versions 2 and 3. Every init needs its free. */
status dnn_memory_init(dnnl_memory_desc_t *memory, const dnn_shape *shape);
dnn_layout dnn_layout_of(const dnnl_memory_desc_t *memory);
void dnn_memory_free(dnnl_memory_desc_t *memory);

#endif
