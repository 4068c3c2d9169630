#include "nn/cpu/dnn.h"

#include <stdlib.h>
#include <string.h>

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
    return fail(code == dnnl_out_of_memory ? ERROR_MEMORY : ERROR_DEVICE, "oneDNN: %s: %s", what, reason(code));
}

status dnn_open(void **out)
{
    *out = NULL;
    dnn_context *context = calloc(1, sizeof *context);
    if (!context) return fail(ERROR_MEMORY, "no memory for a device");
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

dnnl_data_type_t dnn_type(nn_type type)
{
    return type == NN_BFLOAT16 ? dnnl_bf16 : dnnl_f32;
}

dnnl_memory_desc_t dnn_activation(const nn_tensor *t, nn_type type)
{
    dnnl_memory_desc_t layout;
    const dnnl_dims_t size = {t->n, t->c, t->h, t->w};
    dnnl_memory_desc_init_by_tag(&layout, 4, size, dnn_type(type), dnnl_nhwc);
    return layout;
}

static status make_attributes(dnnl_primitive_attr_t *attributes, bool relu)
{
    dnnl_post_ops_t post = NULL;
    dnnl_status_t code = dnnl_primitive_attr_create(attributes);
    if (code == dnnl_success) code = dnnl_primitive_attr_set_scratchpad_mode(*attributes, dnnl_scratchpad_mode_user);
    if (code == dnnl_success && relu) {
        code = dnnl_post_ops_create(&post);
        if (code == dnnl_success) code = dnnl_post_ops_append_eltwise(post, 1, dnnl_eltwise_relu, 0, 0);
        if (code == dnnl_success) code = dnnl_primitive_attr_set_post_ops(*attributes, post);
        if (post) dnnl_post_ops_destroy(post);
    }
    return dnn_check(code, "attributes");
}

status dnn_describe(dnn_call *call, const dnn_context *context, const void *descriptor, bool relu, const dnn_call *hint)
{
    dnnl_primitive_attr_t attributes = NULL;
    status s = make_attributes(&attributes, relu);
    if (s == OK)
        s = dnn_check(dnnl_primitive_desc_create(&call->description, descriptor, attributes, context->engine,
                                                 hint ? hint->description : NULL),
                      "primitive description");
    if (attributes) dnnl_primitive_attr_destroy(attributes);
    return s;
}

static bool is_called(dnnl_primitive_desc_t description, const char *part)
{
    const char *name = NULL;
    dnnl_primitive_desc_query(description, dnnl_query_impl_info_str, 0, (void *)&name);
    return name && strstr(name, part);
}

static status find_otherwise(dnn_call *call, dnnl_primitive_desc_iterator_t at, const char *avoided)
{
    for (;;) {
        dnnl_primitive_desc_t found = dnnl_primitive_desc_iterator_fetch(at);
        if (!found) return fail(ERROR_MEMORY, "oneDNN: no memory for a primitive description");
        if (!is_called(found, avoided)) {
            call->description = found;
            return OK;
        }
        dnnl_primitive_desc_destroy(found);
        status s = dnn_check(dnnl_primitive_desc_iterator_next(at), "another primitive description");
        if (s != OK) return s;
    }
}

status dnn_describe_otherwise(dnn_call *call, const dnn_context *context, const void *descriptor, const char *avoided,
                              const dnn_call *hint)
{
    dnnl_primitive_attr_t attributes = NULL;
    dnnl_primitive_desc_iterator_t at = NULL;
    status s = make_attributes(&attributes, false);
    if (s == OK)
        s = dnn_check(
            dnnl_primitive_desc_iterator_create(&at, descriptor, attributes, context->engine, hint->description),
            "primitive descriptions");
    if (s == OK) s = find_otherwise(call, at, avoided);
    if (at) dnnl_primitive_desc_iterator_destroy(at);
    if (attributes) dnnl_primitive_attr_destroy(attributes);
    return s;
}

const dnnl_memory_desc_t *dnn_query(const dnn_call *call, dnnl_query_t what)
{
    return dnnl_primitive_desc_query_md(call->description, what, 0);
}

size_t dnn_scratch_bytes(const dnn_call *call)
{
    return call->description ? dnnl_memory_desc_get_size(dnn_query(call, dnnl_query_scratchpad_md)) : 0;
}

status dnn_argument(dnn_call *call, const dnn_context *context, int kind, const dnnl_memory_desc_t *layout, void *data)
{
    dnnl_exec_arg_t *argument = &call->arguments[call->count];
    status s = dnn_check(dnnl_memory_create(&argument->memory, layout, context->engine, data), "memory");
    if (s != OK) return s;
    argument->arg = kind;
    call->count++;
    return OK;
}

status dnn_make(dnn_call *call, void *scratch, const dnn_context *context)
{
    status s = OK;
    if (dnn_scratch_bytes(call))
        s = dnn_argument(call, context, DNNL_ARG_SCRATCHPAD, dnn_query(call, dnnl_query_scratchpad_md), scratch);
    if (s == OK) s = dnn_check(dnnl_primitive_create(&call->primitive, call->description), "primitive");
    return s;
}

status dnn_make_reorder(dnn_call *call, const dnn_context *context, const dnnl_memory_desc_t *from, void *source,
                        const dnnl_memory_desc_t *to, void *target)
{
    status s = dnn_check(
        dnnl_reorder_primitive_desc_create(&call->description, from, context->engine, to, context->engine, NULL),
        "reorder");
    if (s == OK) s = dnn_argument(call, context, DNNL_ARG_FROM, from, source);
    if (s == OK) s = dnn_argument(call, context, DNNL_ARG_TO, to, target);
    if (s == OK) s = dnn_check(dnnl_primitive_create(&call->primitive, call->description), "reorder");
    return s;
}

status dnn_run(const dnn_call *call, const dnn_context *context)
{
    return dnn_check(dnnl_primitive_execute(call->primitive, context->stream, call->count, call->arguments), "execute");
}

void dnn_release(dnn_call *call)
{
    for (int i = 0; i < call->count; i++)
        dnnl_memory_destroy(call->arguments[i].memory);
    if (call->primitive) dnnl_primitive_destroy(call->primitive);
    if (call->description) dnnl_primitive_desc_destroy(call->description);
    *call = (dnn_call){0};
}
