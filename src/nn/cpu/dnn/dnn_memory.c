/* SPDX-License-Identifier: MIT */
#include "nn/cpu/dnn/dnn_memory.h"

static const char *reason(dnnl_status_t code)
{
    switch (code) {
    case dnnl_out_of_memory:
        return "out of memory";
    case dnnl_invalid_arguments:
        return "invalid arguments";
    case dnnl_unimplemented:
        return "not available for these types and sizes";
    default:
        return "runtime error";
    }
}

status dnn_check(dnnl_status_t code, const char *what)
{
    if (code == dnnl_success) return OK;
    return fail(code == dnnl_out_of_memory ? MERLIN_NO_MEMORY : MERLIN_DEVICE_FAILED, "oneDNN: %s: %s", what,
                reason(code));
}

dnnl_data_type_t dnn_type(nn_type type)
{
    return type == NN_BFLOAT16 ? dnnl_bf16 : dnnl_f32;
}

dnn_shape dnn_activation(const nn_tensor *t, nn_type type)
{
    return (dnn_shape){4, {t->n, t->c, t->h, t->w}, dnn_type(type), dnnl_nhwc};
}

#if DNNL_VERSION_MAJOR < 3

status dnn_memory_init(dnnl_memory_desc_t *memory, const dnn_shape *shape)
{
    return dnn_check(dnnl_memory_desc_init_by_tag(memory, shape->rank, shape->size, shape->type, shape->tag),
                     "memory description");
}

dnn_layout dnn_layout_of(const dnnl_memory_desc_t *memory)
{
    return memory;
}

void dnn_memory_free(dnnl_memory_desc_t *memory)
{
    (void)memory;
}

#else

status dnn_memory_init(dnnl_memory_desc_t *memory, const dnn_shape *shape)
{
    *memory = NULL;
    return dnn_check(dnnl_memory_desc_create_with_tag(memory, shape->rank, shape->size, shape->type, shape->tag),
                     "memory description");
}

dnn_layout dnn_layout_of(const dnnl_memory_desc_t *memory)
{
    return *memory;
}

void dnn_memory_free(dnnl_memory_desc_t *memory)
{
    if (*memory) dnnl_memory_desc_destroy(*memory);
    *memory = NULL;
}

#endif
