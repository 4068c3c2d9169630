/* SPDX-License-Identifier: MIT */
#include "nn/cpu/dnn/dnn_pack.h"

#include <stdlib.h>

#include "base/half.h"

struct dnn_packing {
    size_t count;
    const float *source;
    void *target;
    bool bfloat16;
    uint32_t place[]; /* position in the target of each value of the source */
};

#if DNNL_VERSION_MAJOR >= 3

/* A blocked layout: padded sizes, and the distances between neighbours along each dimension, outside the inner blocks
 * and inside them. */
typedef struct blocking {
    const dnnl_dims_t *padded, *strides, *blocks, *dimensions;
    int32_t block_count;
    dnnl_format_kind_t kind;
    dnnl_data_type_t type;
} blocking;

static bool read_blocking(dnn_layout layout, blocking *b)
{
    *b = (blocking){.block_count = 0};
    return dnnl_memory_desc_query(layout, dnnl_query_format_kind, &b->kind) == dnnl_success &&
           b->kind == dnnl_blocked && dnnl_memory_desc_query(layout, dnnl_query_data_type, &b->type) == dnnl_success &&
           dnnl_memory_desc_query(layout, dnnl_query_padded_dims, (void *)&b->padded) == dnnl_success &&
           dnnl_memory_desc_query(layout, dnnl_query_strides, (void *)&b->strides) == dnnl_success &&
           dnnl_memory_desc_query(layout, dnnl_query_inner_nblks_s32, &b->block_count) == dnnl_success &&
           dnnl_memory_desc_query(layout, dnnl_query_inner_blks, (void *)&b->blocks) == dnnl_success &&
           dnnl_memory_desc_query(layout, dnnl_query_inner_idxs, (void *)&b->dimensions) == dnnl_success;
}

static bool is_padded(const blocking *b, const dnn_shape *from)
{
    for (int i = 0; i < from->rank; i++)
        if ((*b->padded)[i] != from->size[i]) return true;
    return false;
}

/* Returns the position of a value; overwrites its indices. */
static uint32_t place_of(const blocking *b, int rank, dnnl_dims_t index)
{
    dnnl_dim_t place = 0, step = 1;
    for (int i = b->block_count; i-- > 0;) {
        dnnl_dim_t *at = &index[(*b->dimensions)[i]], block = (*b->blocks)[i];
        place += *at % block * step;
        *at /= block;
        step *= block;
    }
    for (int i = 0; i < rank; i++)
        place += index[i] * (*b->strides)[i];
    return (uint32_t)place;
}

static void find_places(const blocking *b, const dnn_shape *from, uint32_t *place)
{
    const dnnl_dim_t *n = from->size;
    for (dnnl_dim_t o = 0; o < n[0]; o++)
        for (dnnl_dim_t i = 0; i < n[1]; i++)
            for (dnnl_dim_t y = 0; y < n[2]; y++)
                for (dnnl_dim_t x = 0; x < n[3]; x++)
                    *place++ = place_of(b, from->rank, (dnnl_dims_t){o, i, y, x});
}

status dnn_packing_new(const dnn_shape *from, const float *source, dnn_layout to, void *target, dnn_packing **out)
{
    blocking b;
    *out = NULL;
    if (!read_blocking(to, &b) || !is_padded(&b, from)) return OK;
    size_t count = (size_t)(from->size[0] * from->size[1] * from->size[2] * from->size[3]);
    *out = malloc(sizeof **out + count * sizeof(uint32_t));
    if (!*out) return fail(MERLIN_NO_MEMORY, "no memory for weights");
    (*out)->count = count;
    (*out)->source = source;
    (*out)->target = target;
    (*out)->bfloat16 = b.type == dnnl_bf16;
    find_places(&b, from, (*out)->place);
    return OK;
}

#else

status dnn_packing_new(const dnn_shape *from, const float *source, dnn_layout to, void *target, dnn_packing **out)
{
    (void)from, (void)source, (void)to, (void)target;
    *out = NULL;
    return OK;
}

#endif

void dnn_packing_free(dnn_packing *packing)
{
    free(packing);
}

void dnn_pack(const dnn_packing *p)
{
    float *target = p->target;
    uint16_t *narrow = p->target;
    for (size_t i = 0; i < p->count; i++)
        if (p->bfloat16)
            narrow[p->place[i]] = float_to_bf16(p->source[i]);
        else
            target[p->place[i]] = p->source[i];
}
