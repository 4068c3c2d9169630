/* SPDX-License-Identifier: MIT */
/* A dense channels-last tensor in a device's memory, on which steps and kernels work. */
#ifndef MERLIN_NN_TENSOR_H
#define MERLIN_NN_TENSOR_H

#include <stddef.h>

#include "nn/nn.h"

typedef struct nn_tensor {
    void *data;
    nn_type type;
    int n, h, w, c;
} nn_tensor;

static inline size_t tensor_count(const nn_tensor *t)
{
    return (size_t)t->n * (size_t)t->h * (size_t)t->w * (size_t)t->c;
}

static inline size_t tensor_bytes(const nn_tensor *t)
{
    return tensor_count(t) * (t->type == NN_FLOAT32 ? sizeof(float) : sizeof(uint16_t));
}

#endif
