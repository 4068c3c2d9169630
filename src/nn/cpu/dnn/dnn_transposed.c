/* SPDX-License-Identifier: MIT */
/* Transposed convolutions by oneDNN: with the convolution from the result back to the input, the result is the gradient
 * of that one's source, the gradient of the input is its result, and the gradient of the weights is its own, with
 * source and target exchanged. */
#include <stdlib.h>

#include "nn/cpu/dnn/dnn_conv_state.h"
#include "nn/cpu/kernels/conv_parts.h"
#include "nn/cpu/kernels/kernels.h"
#include "nn/cpu/kernels/steps.h"

static dnn_shape weights_shape(const nn_step *step, nn_type type, dnnl_format_tag_t order)
{
    const int kernel = step->at.kernel;
    return (dnn_shape){4, {step->in[0].c, step->out.c, kernel, kernel}, dnn_type(type), order};
}

/* Returns the convolution from the result to the input. */
static dnn_convolution convolution_of(const nn_step *step, dnnl_prop_kind_t kind, nn_type weights, const dnn_call *hint)
{
    const int stride = step->at.stride, around = (step->at.kernel - stride) / 2;
    return (dnn_convolution){
        .kind = kind,
        .source = dnn_activation(&step->out, step->compute),
        .weights = weights_shape(step, weights, dnnl_format_tag_any),
        .target = dnn_activation(&step->in[0], step->compute),
        .hint = hint,
        .strides = {stride, stride},
        .before = {around, around},
        .behind = {around, around},
    };
}

static status describe(dnn_call *call, const nn_step *step, dnnl_prop_kind_t kind, nn_type weights,
                       const dnn_call *hint)
{
    const dnn_convolution wanted = convolution_of(step, kind, weights, hint);
    return dnn_describe(call, step->context, &wanted);
}

static size_t accumulated_bytes(const nn_step *step)
{
    return step->wants[0] ? conv_align(tensor_bytes(&step->in[0])) : 0;
}

static status describe_backward(nn_step *step, dnn_conv_state *state, const dnn_call *hint)
{
    status s = OK;
    if (step->wants[0]) {
        s = describe(&state->data, step, dnnl_forward_training, step->compute, NULL);
        if (s == OK) s = dnn_conv_own(step, dnn_query(&state->data, dnnl_query_weights_md), &state->data_weights);
    }
    if (s == OK) s = describe(&state->weights, step, dnnl_backward_weights, NN_FLOAT32, hint);
    if (s == OK)
        s = dnn_conv_own(step, dnn_query(&state->weights, dnnl_query_diff_weights_md), &state->weight_gradient);
    if (s != OK) return s;
    const size_t data = dnn_scratch_bytes(&state->data), weights = dnn_scratch_bytes(&state->weights);
    /* gradient of the input before accumulation, oneDNN's own */
    step->backward_scratch = accumulated_bytes(step) + (data > weights ? data : weights);
    return OK;
}

static status bind_forward(nn_step *step, dnn_conv_state *state)
{
    const dnn_context *context = step->context;
    dnn_call *call = &state->forward;
    const dnn_shape x = dnn_activation(&step->in[0], step->compute), y = dnn_activation(&step->out, step->compute);
    status s = dnn_argument_of(call, context, DNNL_ARG_DIFF_DST, &x, step->in[0].data);
    if (s == OK)
        s = dnn_argument(call, context, DNNL_ARG_WEIGHTS, dnn_query(call, dnnl_query_weights_md),
                         state->forward_weights);
    if (s == OK) s = dnn_argument_of(call, context, DNNL_ARG_DIFF_SRC, &y, step->out.data);
    return s == OK ? dnn_make(call, step->forward_space, context) : s;
}

static void *library_place(const nn_step *step)
{
    return (char *)step->backward_space + accumulated_bytes(step);
}

static status bind_data(nn_step *step, dnn_conv_state *state)
{
    const dnn_context *context = step->context;
    dnn_call *call = &state->data;
    const dnn_shape dx = dnn_activation(&step->in[0], step->compute), dy = dnn_activation(&step->out, step->compute);
    void *target = step->accumulate[0] ? step->backward_space : step->in_gradient[0].data;
    status s = dnn_argument_of(call, context, DNNL_ARG_SRC, &dy, step->out_gradient.data);
    if (s == OK)
        s = dnn_argument(call, context, DNNL_ARG_WEIGHTS, dnn_query(call, dnnl_query_weights_md), state->data_weights);
    if (s == OK) s = dnn_argument_of(call, context, DNNL_ARG_DST, &dx, target);
    return s == OK ? dnn_make(call, library_place(step), context) : s;
}

static status bind_weights(nn_step *step, dnn_conv_state *state)
{
    const dnn_context *context = step->context;
    dnn_call *call = &state->weights;
    const dnn_shape x = dnn_activation(&step->in[0], step->compute), dy = dnn_activation(&step->out, step->compute);
    dnn_layout dw = dnn_query(call, dnnl_query_diff_weights_md);
    status s = dnn_argument_of(call, context, DNNL_ARG_SRC, &dy, step->out_gradient.data);
    if (s == OK) s = dnn_argument_of(call, context, DNNL_ARG_DIFF_DST, &x, step->in[0].data);
    if (s == OK) s = dnn_argument(call, context, DNNL_ARG_DIFF_WEIGHTS, dw, state->weight_gradient);
    if (s == OK) s = dnn_make(call, library_place(step), context);
    return s == OK ? dnn_conv_collect(step, state) : s;
}

static status transposed_bind(nn_step *step)
{
    dnn_conv_state *state = step->state;
    status s = bind_forward(step, state);
    if (s == OK && step->backs && step->wants[0]) s = bind_data(step, state);
    if (s == OK && step->backs) s = bind_weights(step, state);
    return s;
}

static status transposed_forward(nn_step *step)
{
    const dnn_conv_state *state = step->state;
    return dnn_run(&state->forward, step->context);
}

static status transposed_backward(nn_step *step)
{
    const dnn_conv_state *state = step->state;
    status s = dnn_run(&state->weights, step->context);
    if (s == OK) s = dnn_run(&state->collect, step->context);
    if (s != OK || !step->wants[0]) return s;
    s = dnn_run(&state->data, step->context);
    if (s != OK || !step->accumulate[0]) return s;
    nn_tensor fresh = step->in_gradient[0];
    fresh.data = step->backward_space;
    cpu_cast(&fresh, &step->in_gradient[0], true);
    return OK;
}

status transposed_create(nn_step *step)
{
    static const step_functions functions = {transposed_bind, dnn_conv_refresh, transposed_forward, transposed_backward,
                                             dnn_conv_release};
    dnn_conv_state *state = calloc(1, sizeof *state);
    if (!state) return fail(MERLIN_NO_MEMORY, "no memory for a convolution");
    step->run = &functions;
    step->state = state;
    step->reads_in = true;
    state->plain = weights_shape(step, NN_FLOAT32, dnnl_oihw);
    conv_count_flops(step);
    dnn_call hint = {0};
    status s = describe(&hint, step, dnnl_forward_training, step->compute, NULL);
    if (s == OK) s = describe(&state->forward, step, dnnl_backward_data, step->compute, &hint);
    if (s == OK) s = dnn_conv_own(step, dnn_query(&state->forward, dnnl_query_weights_md), &state->forward_weights);
    if (s == OK) {
        const size_t library = dnn_scratch_bytes(&state->forward), weights = conv_weights_bytes(step);
        step->forward_scratch = library > weights ? library : weights;
        if (step->backs) s = describe_backward(step, state, &hint);
    }
    dnn_release(&hint);
    return s;
}
