/* SPDX-License-Identifier: MIT */
/* Short words for what oneDNN computes on: statuses with messages, channels-last shapes, descriptions of memory.
 * Internal to src/nn/cpu. */
#ifndef MERLIN_NN_CPU_DNN_DNN_MEMORY_H
#define MERLIN_NN_CPU_DNN_DNN_MEMORY_H

#include <oneapi/dnnl/dnnl.h>

#include "nn/device.h"

/* OK, or MERLIN_DEVICE_FAILED with "oneDNN: what: reason". */
status dnn_check(dnnl_status_t code, const char *what);

/* A tensor's sizes and type in memory; the tag says in which order, or dnnl_format_tag_any. */
typedef struct dnn_shape {
    int rank;
    dnnl_dims_t size;
    dnnl_data_type_t type;
    dnnl_format_tag_t tag;
} dnn_shape;

/* oneDNN's own description of memory, which belongs to the call it was asked of. */
#if DNNL_VERSION_MAJOR < 3
typedef const dnnl_memory_desc_t *dnn_layout;
#else
typedef const_dnnl_memory_desc_t dnn_layout;
#endif

dnnl_data_type_t dnn_type(nn_type type);
/* Returns the channels-last shape of a tensor in a type. */
dnn_shape dnn_activation(const nn_tensor *t, nn_type type);

/* Hides the differences between versions 2 and 3. Every init needs its free. */
status dnn_memory_init(dnnl_memory_desc_t *memory, const dnn_shape *shape);
dnn_layout dnn_layout_of(const dnnl_memory_desc_t *memory);
void dnn_memory_free(dnnl_memory_desc_t *memory);

#endif
