/* SPDX-License-Identifier: MIT */
/* A named tensor of a safetensors file. */
#ifndef MERLIN_NN_SAFETENSORS_TENSOR_H
#define MERLIN_NN_SAFETENSORS_TENSOR_H

#include <stddef.h>
#include <stdint.h>

typedef enum safetensors_type { SAFETENSORS_F32, SAFETENSORS_F16, SAFETENSORS_BF16, SAFETENSORS_I64 } safetensors_type;

typedef struct safetensors_tensor {
    const char *name;
    safetensors_type type;
    int rank; /* at most 4 */
    int64_t shape[4];
    size_t count;
    const void *data; /* count elements of type, may be unaligned */
} safetensors_tensor;

static inline size_t safetensors_type_size(safetensors_type type)
{
    return type == SAFETENSORS_I64 ? 8 : type == SAFETENSORS_F32 ? 4 : 2;
}

static inline size_t safetensors_bytes_of(const safetensors_tensor *t)
{
    return t->count * safetensors_type_size(t->type);
}

#endif
