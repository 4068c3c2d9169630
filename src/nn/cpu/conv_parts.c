#include "nn/cpu/conv_parts.h"

#include <math.h>

#include "base/memory.h"
#include "nn/cpu/chunk.h"
#include "nn/cpu/kernels.h"
#include "nn/cpu/norm.h"

void conv_count_flops(nn_step *step)
{
    const nn_tensor *x = &step->in[0], *y = &step->out;
    double pixels = (double)y->n * y->h * y->w;
    step->forward_flops = 2 * pixels * x->c * y->c * step->at.kernel * step->at.kernel;
    if (step->backs) step->backward_flops = step->forward_flops * (step->wants[0] ? 2 : 1);
}

status conv_own(nn_step *step, size_t bytes, void **memory)
{
    *memory = memory_new(bytes);
    step->own_bytes += bytes;
    return *memory ? OK : fail(ERROR_MEMORY, "no memory for weights");
}

size_t conv_folded_bytes(const nn_step *step)
{
    return step->folded.weight ? step->params.weight->count * sizeof(float) : 0;
}

status conv_own_folded_bias(nn_step *step, void **bias)
{
    *bias = NULL;
    return step->folded.weight ? conv_own(step, (size_t)step->out.c * sizeof(float), bias) : OK;
}

void conv_fold(const nn_step *step, float *weights, float *folded_bias)
{
    int in = step->in[0].c, out = step->out.c, taps = step->at.kernel * step->at.kernel;
#pragma omp parallel for schedule(static) if (step->params.weight->count > CPU_PARALLEL_MIN)
    for (int o = 0; o < out; o++) {
        float factor = step->folded.weight->value[o] / sqrtf(step->folded.running_var->value[o] + NORM_EPSILON);
        float bias = step->params.bias ? step->params.bias->value[o] : 0;
        folded_bias[o] = step->folded.bias->value[o] + (bias - step->folded.running_mean->value[o]) * factor;
        size_t row = (size_t)in * (size_t)taps, at = (size_t)o * row;
        for (size_t i = at; i < at + row; i++)
            weights[i] = step->params.weight->value[i] * factor;
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
