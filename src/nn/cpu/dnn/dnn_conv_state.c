/* SPDX-License-Identifier: MIT */
#include "nn/cpu/dnn/dnn_conv_state.h"

#include <stdlib.h>

#include "base/memory.h"
#include "nn/cpu/kernels/conv_parts.h"

status dnn_conv_own(nn_step *step, dnn_layout layout, void **memory)
{
    return conv_own(step, dnnl_memory_desc_get_size(layout), memory);
}

/* Makes the conversions where they are first used: oneDNN fixes the number of threads at the one in force then. */
static status make_conversions(const nn_step *step, dnn_conv_state *state)
{
    const dnn_context *context = step->context;
    float *master = conv_weights(step, step->forward_space);
    dnn_layout w = dnn_query(&state->forward, dnnl_query_weights_md);
    status s = dnn_make_reorder_to(&state->convert, context, &state->plain, master, w, state->forward_weights);
    if (s != OK || !state->data.primitive) return s;
    w = dnn_query(&state->data, dnnl_query_weights_md);
    return dnn_make_reorder_to(&state->convert_back, context, &state->plain, master, w, state->data_weights);
}

static bool is_made(const dnn_call *conversion)
{
    return conversion->primitive || conversion->packing;
}

status dnn_conv_refresh(nn_step *step)
{
    dnn_conv_state *state = step->state;
    status s = is_made(&state->convert) ? OK : make_conversions(step, state);
    if (s != OK) return s;
    /* into the forward scratch, which is free between runs */
    conv_make_weights(step, step->forward_space, state->folded_bias);
    s = dnn_run(&state->convert, step->context);
    if (s == OK && is_made(&state->convert_back)) s = dnn_run(&state->convert_back, step->context);
    return s;
}

status dnn_conv_collect(const nn_step *step, dnn_conv_state *state)
{
    return dnn_make_reorder_from(&state->collect, step->context, dnn_query(&state->weights, dnnl_query_diff_weights_md),
                                 state->weight_gradient, &state->plain, step->params.weight->gradient);
}

void dnn_conv_release(nn_step *step)
{
    dnn_conv_state *state = step->state;
    dnn_call *calls[] = {&state->forward, &state->data,         &state->weights,
                         &state->convert, &state->convert_back, &state->collect};
    for (size_t i = 0; i < sizeof calls / sizeof calls[0]; i++)
        dnn_release(calls[i]);
    memory_free(state->folded_bias);
    memory_free(state->forward_weights);
    memory_free(state->data_weights);
    memory_free(state->weight_gradient);
    free(state);
}
