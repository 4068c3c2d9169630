/* SPDX-License-Identifier: MIT */
/* Descriptions of convolutions for oneDNN's version 2 or 3, by the header's version. */
#include <string.h>

#include "nn/cpu/dnn/dnn.h"

typedef struct memories {
    dnnl_memory_desc_t source, weights, bias, target, beside;
} memories;

#if DNNL_VERSION_MAJOR < 3

static dnnl_status_t append_relu(dnnl_post_ops_t post)
{
    return dnnl_post_ops_append_eltwise(post, 1, dnnl_eltwise_relu, 0, 0);
}

static dnnl_status_t describe_operation(const dnn_convolution *c, const memories *m, dnnl_convolution_desc_t *out)
{
    const dnnl_memory_desc_t *bias = c->has_bias ? &m->bias : NULL;
    const dnnl_alg_kind_t direct = dnnl_convolution_direct;
    if (c->kind == dnnl_backward_data)
        return dnnl_dilated_convolution_backward_data_desc_init(out, direct, &m->source, &m->weights, &m->target,
                                                                c->strides, c->gaps, c->before, c->behind);
    if (c->kind == dnnl_backward_weights)
        return dnnl_dilated_convolution_backward_weights_desc_init(
            out, direct, &m->source, &m->weights, bias, &m->target, c->strides, c->gaps, c->before, c->behind);
    return dnnl_dilated_convolution_forward_desc_init(out, c->kind, direct, &m->source, &m->weights, bias, &m->target,
                                                      c->strides, c->gaps, c->before, c->behind);
}

/* An iteration over implementations; the iterator keeps reading the operation, so that both stay together. */
typedef struct walk {
    dnnl_convolution_desc_t operation;
    dnnl_primitive_desc_iterator_t at;
} walk;

static dnnl_status_t first_of(const dnn_convolution *c, const memories *m, dnnl_primitive_attr_t attributes,
                              dnnl_engine_t engine, walk *w, dnnl_primitive_desc_t *found)
{
    dnnl_status_t code = describe_operation(c, m, &w->operation);
    if (code == dnnl_success)
        code = dnnl_primitive_desc_iterator_create(&w->at, &w->operation, attributes, engine,
                                                   c->hint ? c->hint->description : NULL);
    if (code != dnnl_success) return code;
    *found = dnnl_primitive_desc_iterator_fetch(w->at);
    return *found ? dnnl_success : dnnl_out_of_memory;
}

static dnnl_status_t next_of(walk *w, dnnl_primitive_desc_t *found)
{
    dnnl_primitive_desc_destroy(*found);
    *found = NULL;
    dnnl_status_t code = dnnl_primitive_desc_iterator_next(w->at);
    if (code != dnnl_success) return code;
    *found = dnnl_primitive_desc_iterator_fetch(w->at);
    return *found ? dnnl_success : dnnl_out_of_memory;
}

static void end_walk(walk *w)
{
    if (w->at) dnnl_primitive_desc_iterator_destroy(w->at);
}

#else

static dnnl_status_t append_relu(dnnl_post_ops_t post)
{
    return dnnl_post_ops_append_eltwise(post, dnnl_eltwise_relu, 0, 0);
}

/* An iteration over implementations, which in this version a description does itself. */
typedef struct walk {
    dnnl_primitive_desc_t at; /* borrowed */
} walk;

static dnnl_status_t first_of(const dnn_convolution *c, const memories *m, dnnl_primitive_attr_t attributes,
                              dnnl_engine_t engine, walk *w, dnnl_primitive_desc_t *found)
{
    const dnnl_alg_kind_t direct = dnnl_convolution_direct;
    const dnnl_memory_desc_t bias = c->has_bias ? m->bias : NULL;
    const_dnnl_primitive_desc_t hint = c->hint ? c->hint->description : NULL;
    (void)w;
    if (c->kind == dnnl_backward_data)
        return dnnl_convolution_backward_data_primitive_desc_create(found, engine, direct, m->source, m->weights,
                                                                    m->target, c->strides, c->gaps, c->before,
                                                                    c->behind, hint, attributes);
    if (c->kind == dnnl_backward_weights)
        return dnnl_convolution_backward_weights_primitive_desc_create(found, engine, direct, m->source, m->weights,
                                                                       bias, m->target, c->strides, c->gaps, c->before,
                                                                       c->behind, hint, attributes);
    return dnnl_convolution_forward_primitive_desc_create(found, engine, c->kind, direct, m->source, m->weights, bias,
                                                          m->target, c->strides, c->gaps, c->before, c->behind,
                                                          attributes);
}

static dnnl_status_t next_of(walk *w, dnnl_primitive_desc_t *found)
{
    (void)w;
    return dnnl_primitive_desc_next_impl(*found);
}

static void end_walk(walk *w)
{
    (void)w;
}

#endif

static status make_attributes(dnnl_primitive_attr_t *attributes, const memories *m, const dnn_convolution *wanted)
{
    dnnl_post_ops_t post = NULL;
    dnnl_status_t code = dnnl_primitive_attr_create(attributes);
    if (code == dnnl_success) code = dnnl_primitive_attr_set_scratchpad_mode(*attributes, dnnl_scratchpad_mode_user);
    if (code == dnnl_success && (wanted->relu || wanted->has_beside)) {
        code = dnnl_post_ops_create(&post);
        if (code == dnnl_success && wanted->has_beside)
            code = dnnl_post_ops_append_binary(post, dnnl_binary_add, dnn_layout_of(&m->beside));
        if (code == dnnl_success && wanted->relu) code = append_relu(post);
        if (code == dnnl_success) code = dnnl_primitive_attr_set_post_ops(*attributes, post);
        if (post) dnnl_post_ops_destroy(post);
    }
    return dnn_check(code, "attributes");
}

static bool is_called(const_dnnl_primitive_desc_t description, const char *part)
{
    const char *name = NULL;
    dnnl_primitive_desc_query(description, dnnl_query_impl_info_str, 0, (void *)&name);
    return name && strstr(name, part);
}

bool dnn_is_called(const dnn_call *call, const char *part)
{
    return is_called(call->description, part);
}

/* Describes the first implementation that is not to be avoided. */
static status describe_first(dnn_call *call, const dnn_context *context, const dnn_convolution *wanted,
                             const memories *m, dnnl_primitive_attr_t attributes)
{
    walk w = {.at = NULL};
    dnnl_primitive_desc_t found = NULL;
    dnnl_status_t code = first_of(wanted, m, attributes, context->engine, &w, &found);
    while (code == dnnl_success && wanted->avoided && is_called(found, wanted->avoided))
        code = next_of(&w, &found);
    end_walk(&w);
    if (code != dnnl_success && found) dnnl_primitive_desc_destroy(found);
    if (code == dnnl_success) call->description = found;
    return dnn_check(code, "convolution");
}

status dnn_describe(dnn_call *call, const dnn_context *context, const dnn_convolution *wanted)
{
    memories m;
    memset(&m, 0, sizeof m);
    dnnl_primitive_attr_t attributes = NULL;
    status s = dnn_memory_init(&m.source, &wanted->source);
    if (s == OK) s = dnn_memory_init(&m.weights, &wanted->weights);
    if (s == OK && wanted->has_bias) s = dnn_memory_init(&m.bias, &wanted->bias);
    if (s == OK) s = dnn_memory_init(&m.target, &wanted->target);
    if (s == OK && wanted->has_beside) s = dnn_memory_init(&m.beside, &wanted->beside);
    if (s == OK) s = make_attributes(&attributes, &m, wanted);
    if (s == OK) s = describe_first(call, context, wanted, &m, attributes);
    dnnl_memory_desc_t *all[] = {&m.source, &m.weights, &m.bias, &m.target, &m.beside};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        dnn_memory_free(all[i]);
    if (attributes) dnnl_primitive_attr_destroy(attributes);
    return s;
}
