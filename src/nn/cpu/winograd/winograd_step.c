/* SPDX-License-Identifier: MIT */
/* A convolution as a step of the device, by Winograd's filtering. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "nn/cpu/kernels/chunk.h"
#include "nn/cpu/kernels/conv_parts.h"
#include "nn/cpu/kernels/steps.h"
#include "nn/cpu/winograd/winograd.h"

typedef struct state {
    winograd shape;
    void *weights, *weights_back, *folded_bias; /* floats */
} state;

static winograd shape_of(const nn_step *step)
{
    const nn_tensor *x = &step->in[0];
    return (winograd){x->n, x->h, x->w, x->c, step->out.c, parallel_threads(), x->type, step->out.type};
}

static bool is_whole(int channels)
{
    return channels % WINOGRAD_CHANNELS == 0 && channels <= CPU_MAX_CHANNELS;
}

bool winograd_suits(const nn_step *step)
{
    return step->at.kernel == 3 && step->at.stride == 1 && step->at.dilation == 1 &&
           step->in[0].type == step->compute && is_whole(step->in[0].c) && is_whole(step->out.c);
}

static void release(nn_step *step)
{
    state *own = step->state;
    memory_free(own->weights);
    memory_free(own->weights_back);
    memory_free(own->folded_bias);
    free(own);
}

static status refresh(nn_step *step)
{
    const state *own = step->state;
    const winograd *g = &own->shape;
    const float *weight = conv_weights(step, step->forward_space);
    conv_make_weights(step, step->forward_space, own->folded_bias);
    winograd_transform(weight, g->in, g->out, own->weights);
    if (own->weights_back) winograd_transform_back(weight, g->in, g->out, own->weights_back);
    return OK;
}

static status forward(nn_step *step)
{
    const state *own = step->state;
    const void *beside = step->inputs > 1 ? step->in[1].data : NULL;
    winograd_after after = {.bias = own->folded_bias, .beside = beside, .relu = step->relu};
    if (!after.bias && step->params.bias) after.bias = step->params.bias->value;
    winograd_convolve(&own->shape, step->in[0].data, own->weights, &after, step->out.data, step->forward_space);
    return OK;
}

/* Sums the output's gradient over all pixels, in their order. */
static void sum_to_bias(const nn_tensor *dy, float *to)
{
    const size_t pixels = tensor_count(dy) / (size_t)dy->c;
#pragma omp parallel for schedule(static)
    for (int first = 0; first < dy->c; first += WINOGRAD_CHANNELS) {
        float sum[WINOGRAD_CHANNELS] = {0}, room[WINOGRAD_CHANNELS];
        for (size_t i = 0; i < pixels; i++) {
            const float *from = cpu_load(dy, i * (size_t)dy->c + (size_t)first, WINOGRAD_CHANNELS, room);
            for (int c = 0; c < WINOGRAD_CHANNELS; c++)
                sum[c] += from[c];
        }
        memcpy(to + first, sum, sizeof sum);
    }
}

/* Returns the output's gradient as convolutions take it: in the compute type, multiplied by ReLU's derivative. */
static nn_tensor prepare(nn_step *step)
{
    nn_tensor dy = step->out;
    dy.type = step->compute;
    dy.data = conv_prepared(step, step->backward_space);
    conv_prepare(step, step->backward_space);
    return dy;
}

static status backward(nn_step *step)
{
    const state *own = step->state;
    const nn_tensor dy = prepare(step);
    void *room = (char *)step->backward_space + conv_prepared_bytes(step);
    winograd g = own->shape;
    g.to = step->compute;
    winograd_gradient(&g, step->in[0].data, dy.data, step->params.weight->gradient, room);
    if (step->params.bias) sum_to_bias(&dy, step->params.bias->gradient);
    const winograd_after after = {.accumulate = step->accumulate[0]};
    const winograd back = winograd_back(&g);
    if (step->wants[0]) winograd_convolve(&back, dy.data, own->weights_back, &after, step->in_gradient[0].data, room);
    return OK;
}

static void plan_scratch(nn_step *step, const state *own)
{
    size_t room = winograd_room(&own->shape) * sizeof(float), weights = conv_weights_bytes(step);
    step->forward_scratch = room > weights ? room : weights;
    if (!step->backs) return;
    const winograd turned = winograd_back(&own->shape);
    size_t back = winograd_room(&turned), gradient = winograd_gradient_room(&own->shape);
    step->backward_scratch = conv_prepared_bytes(step) + (back > gradient ? back : gradient) * sizeof(float);
}

status winograd_create(nn_step *step)
{
    static const step_functions functions = {NULL, refresh, forward, backward, release};
    state *own = calloc(1, sizeof *own);
    if (!own) return fail(MERLIN_NO_MEMORY, "no memory for a convolution");
    step->run = &functions;
    step->state = own;
    step->reads_in = true;
    step->reads_out = step->relu;
    own->shape = shape_of(step);
    conv_count_flops(step);
    plan_scratch(step, own);
    const size_t bytes = winograd_weights(own->shape.in, own->shape.out) * sizeof(float);
    status s = conv_own_folded_bias(step, &own->folded_bias);
    if (s == OK) s = conv_own(step, bytes, &own->weights);
    return s == OK && step->backs && step->wants[0] ? conv_own(step, bytes, &own->weights_back) : s;
}
