/* SPDX-License-Identifier: MIT */
/* Convolutions by oneDNN. */
#include <stdlib.h>

#include "nn/cpu/dnn/dnn_conv_state.h"
#include "nn/cpu/kernels/conv_parts.h"
#include "nn/cpu/kernels/kernels.h"
#include "nn/cpu/kernels/steps.h"

static dnn_shape weights_shape(const nn_step *step, nn_type type, dnnl_format_tag_t order)
{
    const int kernel = step->at.kernel;
    return (dnn_shape){4, {step->out.c, step->in[0].c, kernel, kernel}, dnn_type(type), order};
}

static dnn_shape any_weights(const nn_step *step, nn_type type)
{
    return weights_shape(step, type, dnnl_format_tag_any);
}

static dnn_shape bias_shape(const nn_step *step)
{
    return (dnn_shape){1, {step->out.c}, dnnl_f32, dnnl_a};
}

/* Implementation of 1×1 convolutions by AMX that writes whole tiles of 16 pixels, in oneDNN 2.6.3, also where fewer are
 * left: past the end of a picture of 6×6, into the next picture or tensor. It is avoided for such pictures. */
static const char *const BY_WHOLE_TILES = "jit_1x1:avx512_core_amx";
enum { TILE = 16 };

/* Tells whether oneDNN's gradient may differ from run to run. With fewer than 16 channels, the weights' gradient of
 * oneDNN 2.6.3's 1×1 convolution with a stride differs by up to a quarter between runs on the same numbers, probably
 * because it packs pixels by 16 channels into the next thread's part. To be safe, channel counts that leave a remainder
 * are computed otherwise. */
static bool differs_from_run_to_run(const nn_step *step)
{
    return step->at.kernel == 1 && step->at.stride > 1 && step->in[0].c % 16 != 0;
}

/* Returns a part of the name of implementations that are wrong for a convolution; NULL: none is known. */
static const char *avoided_of(const nn_step *step, dnnl_prop_kind_t kind)
{
    if (kind == dnnl_backward_weights) return differs_from_run_to_run(step) ? "1x1" : NULL;
    const nn_tensor *written = kind == dnnl_backward_data ? &step->in[0] : &step->out;
    return written->h * written->w % TILE != 0 ? BY_WHOLE_TILES : NULL;
}

/* Returns the convolution with its strides and padding: (k - 1)/2 before, the rest behind, of the kernel as wide as
 * dilation makes it. */
static dnn_convolution convolution_of(const nn_step *step, dnnl_prop_kind_t kind)
{
    const int gap = step->at.dilation - 1, k = step->at.kernel + (step->at.kernel - 1) * gap, stride = step->at.stride;
    int before = (k - 1) / 2, behind = k - stride - before;
    if (behind < 0) behind = 0; /* a kernel smaller than its stride skips pixels */
    return (dnn_convolution){
        .kind = kind,
        .source = dnn_activation(&step->in[0], step->compute),
        .weights = any_weights(step, step->compute),
        .bias = bias_shape(step),
        .target = dnn_activation(&step->out, step->compute),
        .strides = {stride, stride},
        .gaps = {gap, gap},
        .before = {before, before},
        .behind = {behind, behind},
        .avoided = avoided_of(step, kind),
    };
}

/* Describes the forward primitive. Convolutions by matrix products, which oneDNN 2.6 falls back to where it has nothing
 * for the processor (on arm64 always, on x86 without AVX2 for few channels), add another pixel's values than those
 * asked for to channels-last results: there the sum is computed behind them. */
static status describe_forward(nn_step *step, dnn_conv_state *state)
{
    dnn_convolution wanted = convolution_of(step, step->train ? dnnl_forward_training : dnnl_forward_inference);
    wanted.target = dnn_activation(&step->out, step->out.type);
    wanted.has_bias = state->has_bias;
    wanted.has_beside = step->inputs > 1;
    if (wanted.has_beside) wanted.beside = dnn_activation(&step->in[1], step->in[1].type);
    wanted.relu = step->relu;
    status s = dnn_describe(&state->forward, step->context, &wanted);
    state->adds_behind = s == OK && wanted.has_beside && dnn_is_called(&state->forward, "gemm");
    if (!state->adds_behind) return s;
    dnn_release(&state->forward);
    wanted.has_beside = wanted.relu = false;
    return dnn_describe(&state->forward, step->context, &wanted);
}

/* Describes the forward primitive that oneDNN needs as a hint for backward: without float32 output and post-operations.
 */
static status describe_hint(nn_step *step, dnn_call *hint)
{
    nn_step bare = *step;
    dnn_conv_state state = {.has_bias = step->at.bias};
    bare.relu = false;
    bare.out.type = step->compute;
    status s = describe_forward(&bare, &state);
    *hint = state.forward;
    return s;
}

static status describe_data(nn_step *step, dnn_conv_state *state, const dnn_call *hint)
{
    dnn_convolution wanted = convolution_of(step, dnnl_backward_data);
    wanted.hint = hint;
    return dnn_describe(&state->data, step->context, &wanted);
}

static status describe_weights(nn_step *step, dnn_conv_state *state, const dnn_call *hint)
{
    dnn_convolution wanted = convolution_of(step, dnnl_backward_weights);
    wanted.weights = any_weights(step, NN_FLOAT32);
    wanted.has_bias = state->has_bias;
    wanted.hint = hint;
    return dnn_describe(&state->weights, step->context, &wanted);
}

static status describe_backward(nn_step *step, dnn_conv_state *state)
{
    dnn_call hint = {0};
    status s = describe_hint(step, &hint);
    if (s == OK && step->wants[0]) s = describe_data(step, state, &hint);
    if (s == OK) s = describe_weights(step, state, &hint);
    dnn_release(&hint);
    if (s != OK) return s;
    s = dnn_conv_own(step, dnn_query(&state->weights, dnnl_query_diff_weights_md), &state->weight_gradient);
    if (s == OK && step->wants[0])
        s = dnn_conv_own(step, dnn_query(&state->data, dnnl_query_weights_md), &state->data_weights);
    if (s != OK) return s;
    size_t data = dnn_scratch_bytes(&state->data), weights = dnn_scratch_bytes(&state->weights);
    /* prepared gradient, gradient of the input before accumulation, oneDNN's own */
    step->backward_scratch =
        conv_prepared_bytes(step) + conv_align(tensor_bytes(&step->in[0])) + (data > weights ? data : weights);
    return OK;
}

static float *bias_data(const nn_step *step)
{
    const dnn_conv_state *state = step->state;
    return state->folded_bias ? state->folded_bias : step->params.bias->value;
}

static status bind_beside(const nn_step *step, dnn_call *call)
{
    dnn_shape beside = dnn_activation(&step->in[1], step->in[1].type);
    return dnn_argument_of(call, step->context, DNN_ARG_BESIDE, &beside, step->in[1].data);
}

static status bind_forward(nn_step *step, dnn_conv_state *state)
{
    const dnn_context *context = step->context;
    dnn_call *call = &state->forward;
    dnn_shape x = dnn_activation(&step->in[0], step->compute), b = bias_shape(step),
              y = dnn_activation(&step->out, step->out.type);
    dnn_layout w = dnn_query(call, dnnl_query_weights_md);
    status s = dnn_argument_of(call, context, DNNL_ARG_SRC, &x, step->in[0].data);
    if (s == OK) s = dnn_argument(call, context, DNNL_ARG_WEIGHTS, w, state->forward_weights);
    if (s == OK && state->has_bias) s = dnn_argument_of(call, context, DNNL_ARG_BIAS, &b, bias_data(step));
    if (s == OK) s = dnn_argument_of(call, context, DNNL_ARG_DST, &y, step->out.data);
    if (s == OK && step->inputs > 1 && !state->adds_behind) s = bind_beside(step, call);
    return s == OK ? dnn_make(call, step->forward_space, context) : s;
}

/* Return the positions of these parts of the backward scratch. */
static char *prepared_place(const nn_step *step)
{
    return step->backward_space;
}

static char *unaccumulated_place(const nn_step *step)
{
    return prepared_place(step) + conv_prepared_bytes(step);
}

static char *library_place(const nn_step *step)
{
    return unaccumulated_place(step) + conv_align(tensor_bytes(&step->in[0]));
}

static void *gradient_place(const nn_step *step)
{
    return conv_prepared(step, prepared_place(step));
}

static status bind_data(nn_step *step, dnn_conv_state *state)
{
    const dnn_context *context = step->context;
    dnn_call *call = &state->data;
    dnn_shape dx = dnn_activation(&step->in[0], step->compute), dy = dnn_activation(&step->out, step->compute);
    dnn_layout w = dnn_query(call, dnnl_query_weights_md);
    void *target = step->accumulate[0] ? unaccumulated_place(step) : step->in_gradient[0].data;
    status s = dnn_argument_of(call, context, DNNL_ARG_DIFF_DST, &dy, gradient_place(step));
    if (s == OK) s = dnn_argument(call, context, DNNL_ARG_WEIGHTS, w, state->data_weights);
    if (s == OK) s = dnn_argument_of(call, context, DNNL_ARG_DIFF_SRC, &dx, target);
    return s == OK ? dnn_make(call, library_place(step), context) : s;
}

static status bind_weights(nn_step *step, dnn_conv_state *state)
{
    const dnn_context *context = step->context;
    dnn_call *call = &state->weights;
    dnn_shape x = dnn_activation(&step->in[0], step->compute), dy = dnn_activation(&step->out, step->compute),
              db = bias_shape(step);
    dnn_layout dw = dnn_query(call, dnnl_query_diff_weights_md);
    status s = dnn_argument_of(call, context, DNNL_ARG_SRC, &x, step->in[0].data);
    if (s == OK) s = dnn_argument_of(call, context, DNNL_ARG_DIFF_DST, &dy, gradient_place(step));
    if (s == OK) s = dnn_argument(call, context, DNNL_ARG_DIFF_WEIGHTS, dw, state->weight_gradient);
    if (s == OK && state->has_bias)
        s = dnn_argument_of(call, context, DNNL_ARG_DIFF_BIAS, &db, step->params.bias->gradient);
    if (s == OK) s = dnn_make(call, library_place(step), context);
    return s == OK ? dnn_conv_collect(step, state) : s;
}

static status conv_bind(nn_step *step)
{
    dnn_conv_state *state = step->state;
    status s = bind_forward(step, state);
    if (s == OK && step->backs && step->wants[0]) s = bind_data(step, state);
    if (s == OK && step->backs) s = bind_weights(step, state);
    return s;
}

static status conv_forward(nn_step *step)
{
    dnn_conv_state *state = step->state;
    status s = dnn_run(&state->forward, step->context);
    if (s != OK || !state->adds_behind) return s;
    cpu_add(&step->out, &step->in[1], &step->out);
    if (step->relu) cpu_relu(&step->out, &step->out);
    return OK;
}

status conv_backward_data(nn_step *step)
{
    dnn_conv_state *state = step->state;
    status s = dnn_run(&state->data, step->context);
    if (s != OK || !step->accumulate[0]) return s;
    nn_tensor fresh = step->in_gradient[0];
    fresh.data = unaccumulated_place(step);
    cpu_cast(&fresh, &step->in_gradient[0], true);
    return OK;
}

status conv_backward_weights(nn_step *step)
{
    dnn_conv_state *state = step->state;
    status s = dnn_run(&state->weights, step->context);
    return s == OK ? dnn_run(&state->collect, step->context) : s;
}

static status conv_backward(nn_step *step)
{
    conv_prepare(step, prepared_place(step));
    status s = conv_backward_weights(step);
    return s == OK && step->wants[0] ? conv_backward_data(step) : s;
}

status conv_create(nn_step *step)
{
    static const step_functions functions = {conv_bind, dnn_conv_refresh, conv_forward, conv_backward,
                                             dnn_conv_release};
    dnn_conv_state *state = calloc(1, sizeof *state);
    if (!state) return fail(MERLIN_NO_MEMORY, "no memory for a convolution");
    step->run = &functions;
    step->state = state;
    step->reads_in = true;
    step->reads_out = step->relu;
    state->has_bias = step->at.bias || step->folded.weight;
    state->plain = weights_shape(step, NN_FLOAT32, dnnl_oihw);
    conv_count_flops(step);
    status s = conv_own_folded_bias(step, &state->folded_bias);
    if (s == OK) s = describe_forward(step, state);
    if (s == OK) s = dnn_conv_own(step, dnn_query(&state->forward, dnnl_query_weights_md), &state->forward_weights);
    if (s != OK) return s;
    step->forward_scratch = dnn_scratch_bytes(&state->forward);
    if (step->forward_scratch < conv_weights_bytes(step)) step->forward_scratch = conv_weights_bytes(step);
    return step->backs ? describe_backward(step, state) : OK;
}
