/* SPDX-License-Identifier: MIT */
/* A named tensor of a safetensors file. */
#ifndef MERLIN_NN_SAFETENSORS_TENSOR_H
#define MERLIN_NN_SAFETENSORS_TENSOR_H

#include <stddef.h>
#include <stdint.h>

typedef enum st_type { ST_F32, ST_F16, ST_BF16, ST_I64 } st_type;

typedef struct st_tensor {
    const char *name;
    st_type type;
    int rank; /* at most 4 */
    int64_t shape[4];
    size_t count;
    const void *data; /* count elements of type, may be unaligned */
} st_tensor;

static inline size_t st_type_size(st_type type)
{
    return type == ST_I64 ? 8 : type == ST_F32 ? 4 : 2;
}

static inline size_t st_bytes_of(const st_tensor *t)
{
    return t->count * st_type_size(t->type);
}

#endif
