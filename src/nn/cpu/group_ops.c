/* SPDX-License-Identifier: MIT */
#include "nn/cpu/group_ops.h"

#include "nn/cpu/kernels/chunk.h"
#include "nn/cpu/kernels/gather.h"
#include "nn/cpu/kernels/group.h"
#include "nn/cpu/kernels/layer_norm.h"

/* Returns which pictures are there, the second input if there is one. */
static const nn_tensor *present(const nn_step *step)
{
    return step->inputs > 1 ? &step->in[1] : NULL;
}

status group_max_forward(nn_step *step)
{
    cpu_group_max(&step->in[0], present(step), &step->out);
    return OK;
}

status group_max_backward(nn_step *step)
{
    cpu_group_max_backward(&step->in[0], present(step), &step->out, &step->out_gradient, &step->in_gradient[0],
                           step->accumulate[0]);
    return OK;
}

status group_mean_forward(nn_step *step)
{
    cpu_group_mean(&step->in[0], present(step), &step->out);
    return OK;
}

status group_mean_backward(nn_step *step)
{
    cpu_group_mean_backward(present(step), &step->out_gradient, &step->in_gradient[0], step->accumulate[0]);
    return OK;
}

status group_spread_forward(nn_step *step)
{
    cpu_group_spread(&step->in[0], present(step), &step->out);
    return OK;
}

status group_spread_backward(nn_step *step)
{
    cpu_group_spread_backward(&step->in[0], present(step), &step->out_gradient, &step->in_gradient[0],
                              step->accumulate[0]);
    return OK;
}

status group_repeat_forward(nn_step *step)
{
    cpu_group_repeat(&step->in[0], &step->out);
    return OK;
}

status group_repeat_backward(nn_step *step)
{
    cpu_group_repeat_backward(&step->out_gradient, &step->in_gradient[0], step->accumulate[0]);
    return OK;
}

static cpu_heads heads_of(const nn_step *step)
{
    return (cpu_heads){step->at.heads, step->group, present(step)};
}

status group_attention_forward(nn_step *step)
{
    const cpu_heads heads = heads_of(step);
    cpu_group_attention(&step->in[0], &heads, &step->out);
    return OK;
}

status group_attention_backward(nn_step *step)
{
    const cpu_heads heads = heads_of(step);
    cpu_group_attention_backward(&step->in[0], &heads, &step->out_gradient, &step->in_gradient[0], step->accumulate[0]);
    return OK;
}

status group_pool_forward(nn_step *step)
{
    const cpu_heads heads = heads_of(step);
    cpu_group_pool(&step->in[0], &heads, step->params.weight->value, &step->out);
    return OK;
}

size_t group_pool_scratch(const nn_step *step)
{
    return (size_t)CPU_PARTS * (size_t)step->out.c * sizeof(float);
}

status group_pool_backward(nn_step *step)
{
    const cpu_heads heads = heads_of(step);
    const nn_param *query = step->params.weight;
    cpu_group_pool_backward(&step->in[0], &heads, query->value, &step->out_gradient, &step->in_gradient[0],
                            step->accumulate[0], step->backward_space, query->gradient);
    return OK;
}

status layer_norm_forward(nn_step *step)
{
    cpu_layer_norm(&step->in[0], (layer_norm_params){step->params.weight->value, step->params.bias->value}, &step->out);
    return OK;
}

size_t layer_norm_scratch(const nn_step *step)
{
    return layer_norm_partial_floats(step->out.c) * sizeof(float);
}

status layer_norm_backward(nn_step *step)
{
    const nn_param *weight = step->params.weight, *bias = step->params.bias;
    cpu_layer_norm_backward(&step->in[0], (layer_norm_params){weight->value, bias->value}, &step->out_gradient,
                            &step->in_gradient[0], step->accumulate[0], step->backward_space,
                            (layer_norm_params){weight->gradient, bias->gradient});
    return OK;
}

static cpu_places places_of(const nn_step *step)
{
    return (cpu_places){&step->in[1], step->at.reduction};
}

status gather_forward(nn_step *step)
{
    const cpu_places places = places_of(step);
    cpu_gather(&step->in[0], &places, &step->out);
    return OK;
}

size_t gather_scratch(const nn_step *step)
{
    return tensor_count(&step->in[0]) * sizeof(float);
}

status gather_backward(nn_step *step)
{
    const cpu_places places = places_of(step);
    cpu_gather_backward(&places, &step->out_gradient, &step->in_gradient[0], step->accumulate[0], step->backward_space);
    return OK;
}
