/* SPDX-License-Identifier: MIT */
#include "nn/cpu/dnn/dnn.h"

#include <stdlib.h>

#include "nn/cpu/dnn/dnn_pack.h"

#include "base/fragile.h"
#include "base/threads.h"

status dnn_open(void **out)
{
    *out = NULL;
    threads_begin();
    dnn_context *context = calloc(1, sizeof *context);
    if (!context) return fail(MERLIN_NO_MEMORY, "no memory for a device");
    status s = dnn_check(dnnl_engine_create(&context->engine, dnnl_cpu, 0), "engine");
    if (s == OK)
        s = dnn_check(dnnl_stream_create(&context->stream, context->engine, dnnl_stream_default_flags), "stream");
    if (s == OK)
        *out = context;
    else
        dnn_close(context);
    return s;
}

void dnn_close(void *p)
{
    dnn_context *context = p;
    if (context->stream) dnnl_stream_destroy(context->stream);
    if (context->engine) dnnl_engine_destroy(context->engine);
    free(context);
}

dnn_layout dnn_query(const dnn_call *call, dnnl_query_t what)
{
    return dnnl_primitive_desc_query_md(call->description, what, 0);
}

size_t dnn_scratch_bytes(const dnn_call *call)
{
    return call->description ? dnnl_memory_desc_get_size(dnn_query(call, dnnl_query_scratchpad_md)) : 0;
}

status dnn_argument(dnn_call *call, const dnn_context *context, int kind, dnn_layout layout, void *data)
{
    dnnl_exec_arg_t *argument = &call->arguments[call->count];
    status s = dnn_check(dnnl_memory_create(&argument->memory, layout, context->engine, data), "memory");
    if (s != OK) return s;
    argument->arg = kind;
    call->count++;
    return OK;
}

status dnn_argument_of(dnn_call *call, const dnn_context *context, int kind, const dnn_shape *shape, void *data)
{
    dnnl_memory_desc_t memory;
    status s = dnn_memory_init(&memory, shape);
    if (s != OK) return s;
    s = dnn_argument(call, context, kind, dnn_layout_of(&memory), data);
    dnn_memory_free(&memory);
    return s;
}

/* Makes a primitive. oneDNN generates machine code here, and does not check whether it got memory for it. */
static status make_primitive(dnn_call *call, const char *what)
{
    enum { MOST_CODE = 32 << 20 };
    status s = fragile_begin("the network's machine code", MOST_CODE);
    if (s != OK) return s;
    s = dnn_check(dnnl_primitive_create(&call->primitive, call->description), what);
    fragile_end();
    return s;
}

status dnn_make(dnn_call *call, void *scratch, const dnn_context *context)
{
    status s = OK;
    if (dnn_scratch_bytes(call))
        s = dnn_argument(call, context, DNNL_ARG_SCRATCHPAD, dnn_query(call, dnnl_query_scratchpad_md), scratch);
    return s == OK ? make_primitive(call, "primitive") : s;
}

static status make_reorder(dnn_call *call, const dnn_context *context, dnn_layout from, void *source, dnn_layout to,
                           void *target)
{
    status s = dnn_check(
        dnnl_reorder_primitive_desc_create(&call->description, from, context->engine, to, context->engine, NULL),
        "reorder");
    if (s == OK) s = dnn_argument(call, context, DNNL_ARG_FROM, from, source);
    if (s == OK) s = dnn_argument(call, context, DNNL_ARG_TO, to, target);
    return s == OK ? make_primitive(call, "reorder") : s;
}

status dnn_make_reorder_from(dnn_call *call, const dnn_context *context, dnn_layout from, void *source,
                             const dnn_shape *to, void *target)
{
    dnnl_memory_desc_t memory;
    status s = dnn_memory_init(&memory, to);
    if (s != OK) return s;
    s = make_reorder(call, context, from, source, dnn_layout_of(&memory), target);
    dnn_memory_free(&memory);
    return s;
}

status dnn_make_reorder_to(dnn_call *call, const dnn_context *context, const dnn_shape *from, float *source,
                           dnn_layout to, void *target)
{
    dnnl_memory_desc_t memory;
    status s = dnn_packing_new(from, source, to, target, &call->packing);
    if (s != OK || call->packing) return s;
    s = dnn_memory_init(&memory, from);
    if (s != OK) return s;
    s = make_reorder(call, context, dnn_layout_of(&memory), source, to, target);
    dnn_memory_free(&memory);
    return s;
}

status dnn_run(const dnn_call *call, const dnn_context *context)
{
    if (call->packing) {
        dnn_pack(call->packing);
        return OK;
    }
    return dnn_check(dnnl_primitive_execute(call->primitive, context->stream, call->count, call->arguments), "execute");
}

void dnn_release(dnn_call *call)
{
    for (int i = 0; i < call->count; i++)
        dnnl_memory_destroy(call->arguments[i].memory);
    dnn_packing_free(call->packing);
    if (call->primitive) dnnl_primitive_destroy(call->primitive);
    if (call->description) dnnl_primitive_desc_destroy(call->description);
    *call = (dnn_call){0};
}
