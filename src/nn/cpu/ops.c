/* SPDX-License-Identifier: MIT */
/* Maps each operation to its implementation on the CPU: a row of a table, and functions that unpack a step's tensors
 * for the kernels of nn/cpu/kernels/kernels.h. */
#include "nn/cpu/group_ops.h"
#include "nn/cpu/kernels/kernels.h"
#include "nn/cpu/kernels/steps.h"
#include "nn/cpu/tuning.h"

static status cast_forward(nn_step *step)
{
    cpu_cast(&step->in[0], &step->out, false);
    return OK;
}

static status cast_backward(nn_step *step)
{
    cpu_cast(&step->out_gradient, &step->in_gradient[0], step->accumulate[0]);
    return OK;
}

static status relu_forward(nn_step *step)
{
    cpu_relu(&step->in[0], &step->out);
    return OK;
}

static status relu_backward(nn_step *step)
{
    cpu_relu_backward(&step->out, &step->out_gradient, &step->in_gradient[0], step->accumulate[0]);
    return OK;
}

static status tanh_forward(nn_step *step)
{
    cpu_tanh(&step->in[0], &step->out);
    return OK;
}

static status tanh_backward(nn_step *step)
{
    cpu_tanh_backward(&step->out, &step->out_gradient, &step->in_gradient[0], step->accumulate[0]);
    return OK;
}

static status sigmoid_forward(nn_step *step)
{
    cpu_sigmoid(&step->in[0], &step->out);
    return OK;
}

static status sigmoid_backward(nn_step *step)
{
    cpu_sigmoid_backward(&step->out, &step->out_gradient, &step->in_gradient[0], step->accumulate[0]);
    return OK;
}

static status concat_forward(nn_step *step)
{
    int first = 0;
    for (int k = 0; k < step->inputs; k++) {
        cpu_insert_channels(&step->in[k], &step->out, first, false);
        first += step->in[k].c;
    }
    return OK;
}

static status concat_backward(nn_step *step)
{
    int first = 0;
    for (int k = 0; k < step->inputs; k++) {
        if (step->wants[k])
            cpu_extract_channels(&step->out_gradient, first, &step->in_gradient[k], step->accumulate[k]);
        first += step->in[k].c;
    }
    return OK;
}

static status slice_forward(nn_step *step)
{
    cpu_extract_channels(&step->in[0], step->at.first, &step->out, false);
    return OK;
}

static status slice_backward(nn_step *step)
{
    if (!step->accumulate[0]) cpu_zero(&step->in_gradient[0]); /* the channels outside the slice */
    cpu_insert_channels(&step->out_gradient, &step->in_gradient[0], step->at.first, step->accumulate[0]);
    return OK;
}

static status add_forward(nn_step *step)
{
    cpu_add(&step->in[0], &step->in[1], &step->out);
    return OK;
}

static status add_backward(nn_step *step)
{
    for (int k = 0; k < 2; k++)
        if (step->wants[k]) cpu_cast(&step->out_gradient, &step->in_gradient[k], step->accumulate[k]);
    return OK;
}

static status gate_forward(nn_step *step)
{
    cpu_gate(&step->in[0], &step->in[1], &step->out);
    return OK;
}

static status gate_backward(nn_step *step)
{
    cpu_gate_backward(&step->in[0], &step->in[1], &step->out_gradient, &step->in_gradient[0], step->accumulate[0],
                      &step->in_gradient[1], step->accumulate[1]);
    return OK;
}

static status scale_shift_forward(nn_step *step)
{
    cpu_scale_shift(&step->in[0], &step->out, step->at.scale, step->at.shift);
    return OK;
}

static status scale_shift_backward(nn_step *step)
{
    cpu_scale_shift_backward(&step->out_gradient, &step->in_gradient[0], step->at.scale, step->accumulate[0]);
    return OK;
}

static status upsample_bilinear_forward(nn_step *step)
{
    cpu_upsample_bilinear(&step->in[0], &step->out);
    return OK;
}

static status upsample_bilinear_backward(nn_step *step)
{
    cpu_upsample_bilinear_backward(&step->out_gradient, &step->in_gradient[0], step->accumulate[0]);
    return OK;
}

static status tile_forward(nn_step *step)
{
    cpu_tile(&step->in[0], &step->out);
    return OK;
}

static status tile_backward(nn_step *step)
{
    cpu_tile_backward(&step->out_gradient, &step->in_gradient[0], step->accumulate[0]);
    return OK;
}

static status space_to_depth_forward(nn_step *step)
{
    cpu_space_to_depth(&step->in[0], &step->out, step->at.block, false);
    return OK;
}

static status space_to_depth_backward(nn_step *step)
{
    cpu_depth_to_space(&step->out_gradient, &step->in_gradient[0], step->at.block, step->accumulate[0]);
    return OK;
}

static status depth_to_space_forward(nn_step *step)
{
    cpu_depth_to_space(&step->in[0], &step->out, step->at.block, false);
    return OK;
}

static status depth_to_space_backward(nn_step *step)
{
    cpu_space_to_depth(&step->out_gradient, &step->in_gradient[0], step->at.block, step->accumulate[0]);
    return OK;
}

static status spatial_mean_forward(nn_step *step)
{
    cpu_spatial_mean(&step->in[0], &step->out);
    return OK;
}

static status spatial_mean_backward(nn_step *step)
{
    cpu_spatial_mean_backward(&step->out_gradient, &step->in_gradient[0], step->accumulate[0]);
    return OK;
}

static status normalize_forward(nn_step *step)
{
    cpu_normalize(&step->in[0], &step->out);
    return OK;
}

static status normalize_backward(nn_step *step)
{
    cpu_normalize_backward(&step->in[0], &step->out, &step->out_gradient, &step->in_gradient[0], step->accumulate[0]);
    return OK;
}

static status reciprocal_forward(nn_step *step)
{
    cpu_reciprocal(&step->in[0], &step->out, step->at.scale, step->at.shift);
    return OK;
}

static status reciprocal_backward(nn_step *step)
{
    cpu_reciprocal_backward(&step->out, &step->out_gradient, &step->in_gradient[0], step->at.scale,
                            step->accumulate[0]);
    return OK;
}

static cpu_render_tensors render_tensors(const nn_tensor *t)
{
    return (cpu_render_tensors){t[0], t[1], t[2], t[3]};
}

static cpu_render_view render_view(const nn_step *step)
{
    cpu_render_view view = {step->in[4], step->in[5], {0}, step->at.fov, step->at.light_power};
    if (step->inputs > 6) view.lens = step->in[6];
    return view;
}

static status render_forward(nn_step *step)
{
    cpu_render_tensors maps = render_tensors(step->in);
    const cpu_render_view view = render_view(step);
    cpu_render(&maps, &view, &step->out);
    return OK;
}

static status render_backward(nn_step *step)
{
    cpu_render_tensors maps = render_tensors(step->in), gradients = render_tensors(step->in_gradient);
    cpu_render_accumulate accumulate = {step->accumulate[0], step->accumulate[1], step->accumulate[2],
                                        step->accumulate[3]};
    const cpu_render_view view = render_view(step);
    cpu_render_backward(&maps, &view, &step->out_gradient, &gradients, accumulate);
    return OK;
}

static cpu_environment environment_tensors(const nn_tensor *t)
{
    return (cpu_environment){t[0], t[1], t[2]};
}

static status environment_forward(nn_step *step)
{
    cpu_environment in = environment_tensors(step->in);
    cpu_shade_environment(&in, &step->in[3], &step->out);
    return OK;
}

static status environment_backward(nn_step *step)
{
    cpu_environment in = environment_tensors(step->in), gradients = environment_tensors(step->in_gradient);
    cpu_environment_accumulate accumulate = {step->accumulate[0], step->accumulate[1], step->accumulate[2]};
    cpu_environment_backward(&in, &step->in[3], &step->out_gradient, &gradients, accumulate);
    return OK;
}

/* Computes the mean over the masks of all ranks, whose sum also divides the gradients. */
static status sum_loss(nn_step *step)
{
    if (ranks_count(step->together) == 1) return OK;
    double sums[] = {(double)step->loss * step->mask_sum, step->mask_sum};
    status s = ranks_sum(step->together, sums, 2);
    step->loss = sums[1] > 0 ? (float)(sums[0] / sums[1]) : 0;
    step->mask_sum = sums[1];
    return s;
}

static status masked_l2_forward(nn_step *step)
{
    const nn_tensor *x = step->in;
    step->loss = cpu_masked_l2(x, x + 1, x + 2, &step->mask_sum);
    return sum_loss(step);
}

static status masked_l2_backward(nn_step *step)
{
    const nn_tensor *x = step->in;
    cpu_masked_l2_backward(x, x + 1, x + 2, step->mask_sum, step->at.weight, &step->in_gradient[0],
                           step->accumulate[0]);
    return OK;
}

static status masked_gradient_l2_forward(nn_step *step)
{
    const nn_tensor *x = step->in;
    step->loss = cpu_masked_gradient_l2(x, x + 1, x + 2, &step->mask_sum);
    return sum_loss(step);
}

static status masked_gradient_l2_backward(nn_step *step)
{
    const nn_tensor *x = step->in;
    cpu_masked_gradient_l2_backward(x, x + 1, x + 2, step->mask_sum, step->at.weight, &step->in_gradient[0],
                                    step->accumulate[0]);
    return OK;
}

static status masked_dssim_forward(nn_step *step)
{
    const nn_tensor *x = step->in;
    status s = cpu_masked_dssim(x, x + 1, x + 2, &step->mask_sum, &step->loss);
    return s == OK ? sum_loss(step) : s;
}

static status masked_dssim_backward(nn_step *step)
{
    const nn_tensor *x = step->in;
    return cpu_masked_dssim_backward(x, x + 1, x + 2, step->mask_sum, step->at.weight, &step->in_gradient[0],
                                     step->accumulate[0]);
}

static status fastest_conv_create(nn_step *step)
{
    return tuning_filters(step) ? winograd_create(step) : conv_create(step);
}

enum { READS_IN = 1, READS_OUT = 2 };

typedef struct operation {
    status (*create)(nn_step *step); /* for a step with a state of its own, instead of the fields below */
    status (*forward)(nn_step *step), (*backward)(nn_step *step);
    unsigned reads;                                  /* what backward reads apart from out's gradient */
    size_t (*backward_scratch)(const nn_step *step); /* bytes that backward uses; NULL: none */
} operation;

static const operation operations[] = {
    [OP_COMPUTE] = {.forward = cast_forward, .backward = cast_backward},
    [OP_FLOAT] = {.forward = cast_forward, .backward = cast_backward},
    [OP_CONV] = {.create = fastest_conv_create},
    [OP_CONV_TRANSPOSED] = {.create = transposed_create},
    [OP_LINEAR] = {.create = fastest_conv_create},
    [OP_NORM] = {.create = norm_create},
    [OP_RELU] = {.forward = relu_forward, .backward = relu_backward, .reads = READS_OUT},
    [OP_TANH] = {.forward = tanh_forward, .backward = tanh_backward, .reads = READS_OUT},
    [OP_SIGMOID] = {.forward = sigmoid_forward, .backward = sigmoid_backward, .reads = READS_OUT},
    [OP_CONCAT] = {.forward = concat_forward, .backward = concat_backward},
    [OP_SLICE] = {.forward = slice_forward, .backward = slice_backward},
    [OP_ADD] = {.forward = add_forward, .backward = add_backward},
    [OP_STOP] = {.forward = cast_forward, .backward = cast_backward}, /* no gradient ever reaches it */
    [OP_GATE] = {.forward = gate_forward, .backward = gate_backward, .reads = READS_IN},
    [OP_SCALE_SHIFT] = {.forward = scale_shift_forward, .backward = scale_shift_backward},
    [OP_UPSAMPLE_BILINEAR] = {.forward = upsample_bilinear_forward, .backward = upsample_bilinear_backward},
    [OP_TILE] = {.forward = tile_forward, .backward = tile_backward},
    [OP_SPACE_TO_DEPTH] = {.forward = space_to_depth_forward, .backward = space_to_depth_backward},
    [OP_DEPTH_TO_SPACE] = {.forward = depth_to_space_forward, .backward = depth_to_space_backward},
    [OP_SPATIAL_MEAN] = {.forward = spatial_mean_forward, .backward = spatial_mean_backward},
    [OP_NORMALIZE] = {.forward = normalize_forward, .backward = normalize_backward, .reads = READS_IN | READS_OUT},
    [OP_RECIPROCAL] = {.forward = reciprocal_forward, .backward = reciprocal_backward, .reads = READS_OUT},
    [OP_GROUP_MAX] = {.forward = group_max_forward, .backward = group_max_backward, .reads = READS_IN | READS_OUT},
    [OP_GROUP_MEAN] = {.forward = group_mean_forward, .backward = group_mean_backward, .reads = READS_IN},
    [OP_GROUP_SPREAD] = {.forward = group_spread_forward, .backward = group_spread_backward, .reads = READS_IN},
    [OP_GROUP_REPEAT] = {.forward = group_repeat_forward, .backward = group_repeat_backward},
    [OP_GROUP_ATTENTION] = {.forward = group_attention_forward,
                            .backward = group_attention_backward,
                            .reads = READS_IN},
    [OP_GROUP_POOL] = {.forward = group_pool_forward,
                       .backward = group_pool_backward,
                       .reads = READS_IN,
                       .backward_scratch = group_pool_scratch},
    [OP_LAYER_NORM] = {.forward = layer_norm_forward,
                       .backward = layer_norm_backward,
                       .reads = READS_IN,
                       .backward_scratch = layer_norm_scratch},
    [OP_GATHER] = {.forward = gather_forward,
                   .backward = gather_backward,
                   .reads = READS_IN,
                   .backward_scratch = gather_scratch},
    [OP_RENDER] = {.forward = render_forward, .backward = render_backward, .reads = READS_IN},
    [OP_ENVIRONMENT] = {.forward = environment_forward, .backward = environment_backward, .reads = READS_IN},
    [OP_MASKED_L2] = {.forward = masked_l2_forward, .backward = masked_l2_backward, .reads = READS_IN},
    [OP_MASKED_GRADIENT_L2] = {.forward = masked_gradient_l2_forward,
                               .backward = masked_gradient_l2_backward,
                               .reads = READS_IN},
    [OP_MASKED_DSSIM] = {.forward = masked_dssim_forward, .backward = masked_dssim_backward, .reads = READS_IN},
};
_Static_assert(sizeof operations / sizeof *operations == OP_COUNT, "every operation has a row");

static status kernel_forward(nn_step *step)
{
    return operations[step->op].forward(step);
}

static status kernel_backward(nn_step *step)
{
    return operations[step->op].backward(step);
}

static status kernel_create(nn_step *step)
{
    static const step_functions functions = {.forward = kernel_forward, .backward = kernel_backward};
    const operation *row = &operations[step->op];
    if (!row->forward || !row->backward) return fail(MERLIN_DEVICE_FAILED, "%s has no kernel", op_name(step->op));
    step->run = &functions;
    if (step->out.c > CPU_MAX_CHANNELS)
        return fail(MERLIN_WRONG_USE, "%d channels, the CPU's limit is %d", step->out.c, CPU_MAX_CHANNELS);
    step->reads_in = row->reads & READS_IN;
    step->reads_out = row->reads & READS_OUT;
    if (row->backward_scratch && step->backs) step->backward_scratch = row->backward_scratch(step);
    return OK;
}

status step_create(nn_step *step)
{
    const operation *row = &operations[step->op];
    return row->create ? row->create(step) : kernel_create(step);
}
