/* SPDX-License-Identifier: MIT */
#include "nn/cpu/kernels/conv_parts.h"

#include <math.h>

#include "base/half.h"
#include "base/memory.h"
#include "nn/cpu/kernels/chunk.h"
#include "nn/cpu/kernels/kernels.h"
#include "nn/cpu/kernels/norm.h"

void conv_count_flops(nn_step *step)
{
    const nn_tensor *x = &step->in[0], *y = &step->out;
    /* each tap is used once for a pixel of the smaller one: of a transposed convolution that is the input */
    const double pixels = fmin((double)x->h * x->w, (double)y->h * y->w) * y->n;
    step->forward_flops = 2 * pixels * x->c * y->c * step->at.kernel * step->at.kernel;
    if (step->backs) step->backward_flops = step->forward_flops * (step->wants[0] ? 2 : 1);
}

status conv_own(nn_step *step, size_t bytes, void **memory)
{
    *memory = memory_new(bytes);
    step->own_bytes += bytes;
    return *memory ? OK : fail(MERLIN_NO_MEMORY, "no memory for weights");
}

size_t conv_weights_bytes(const nn_step *step)
{
    const nn_param *weight = step->params.weight;
    return step->folded.weight || weight->half ? weight->count * sizeof(float) : 0;
}

float *conv_weights(const nn_step *step, void *place)
{
    return conv_weights_bytes(step) ? place : step->params.weight->value;
}

status conv_own_folded_bias(nn_step *step, void **bias)
{
    *bias = NULL;
    return step->folded.weight ? conv_own(step, (size_t)step->out.c * sizeof(float), bias) : OK;
}

/* Returns batch norm's factor for output channel o and stores its bias in folded_bias; where there is no batch norm to
 * fold, these are 1 and NULL. */
static float fold(const nn_step *step, int o, float *folded_bias)
{
    if (!folded_bias) return 1;
    float factor = step->folded.weight->value[o] / sqrtf(step->folded.running_var->value[o] + NORM_EPSILON);
    float own = step->params.bias ? step->params.bias->value[o] : 0;
    folded_bias[o] = step->folded.bias->value[o] + (own - step->folded.running_mean->value[o]) * factor;
    return factor;
}

void conv_make_weights(const nn_step *step, void *place, float *folded_bias)
{
    if (!conv_weights_bytes(step)) return;
    const nn_param *weight = step->params.weight;
    const size_t row = weight->count / (size_t)step->out.c;
    float *to = place;
#pragma omp parallel for schedule(static) if (weight->count > CPU_PARALLEL_MIN)
    for (int o = 0; o < step->out.c; o++) {
        const float factor = fold(step, o, folded_bias);
        for (size_t i = (size_t)o * row; i < ((size_t)o + 1) * row; i++)
            to[i] = (weight->half ? half_to_float(weight->half[i]) : weight->value[i]) * factor;
    }
}

size_t conv_prepared_bytes(const nn_step *step)
{
    if (!step->relu && step->out_gradient.type == step->compute) return 0;
    nn_tensor t = step->out;
    t.type = step->compute;
    return conv_align(tensor_bytes(&t));
}

void *conv_prepared(const nn_step *step, void *place)
{
    return conv_prepared_bytes(step) ? place : step->out_gradient.data;
}

void conv_prepare(const nn_step *step, void *place)
{
    if (!conv_prepared_bytes(step)) return;
    nn_tensor prepared = step->out;
    prepared.data = place;
    prepared.type = step->compute;
    if (step->relu)
        cpu_relu_backward(&step->out, &step->out_gradient, &prepared, false);
    else
        cpu_cast(&step->out_gradient, &prepared, false);
}
