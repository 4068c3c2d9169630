/* The bridge from steps to the kernels of nn/cpu/kernels.h. */
#include "nn/cpu/kernels.h"
#include "nn/cpu/steps.h"

static void concat_forward(nn_step *step)
{
    int first = 0;
    for (int k = 0; k < step->inputs; k++) {
        cpu_insert_channels(&step->in[k], &step->out, first, false);
        first += step->in[k].c;
    }
}

static void concat_backward(nn_step *step)
{
    int first = 0;
    for (int k = 0; k < step->inputs; k++) {
        if (step->wants[k])
            cpu_extract_channels(&step->out_gradient, first, &step->in_gradient[k], step->accumulate[k]);
        first += step->in[k].c;
    }
}

static void slice_backward(nn_step *step)
{
    if (!step->accumulate[0]) cpu_zero(&step->in_gradient[0]); /* the channels beside the slice */
    cpu_insert_channels(&step->out_gradient, &step->in_gradient[0], step->at.first, step->accumulate[0]);
}

static void add_backward(nn_step *step)
{
    for (int k = 0; k < 2; k++)
        if (step->wants[k]) cpu_cast(&step->out_gradient, &step->in_gradient[k], step->accumulate[k]);
}

static void gate_backward(nn_step *step)
{
    cpu_gate_backward(&step->in[0], &step->in[1], &step->out_gradient, &step->in_gradient[0], step->accumulate[0],
                      &step->in_gradient[1], step->accumulate[1]);
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

static void render_forward(nn_step *step)
{
    cpu_render_tensors maps = render_tensors(step->in);
    const cpu_render_view view = render_view(step);
    cpu_render(&maps, &view, &step->out);
}

static void render_backward(nn_step *step)
{
    cpu_render_tensors maps = render_tensors(step->in), gradients = render_tensors(step->in_gradient);
    cpu_render_accumulate accumulate = {step->accumulate[0], step->accumulate[1], step->accumulate[2],
                                        step->accumulate[3]};
    const cpu_render_view view = render_view(step);
    cpu_render_backward(&maps, &view, &step->out_gradient, &gradients, accumulate);
}

static cpu_environment environment_tensors(const nn_tensor *t)
{
    return (cpu_environment){t[0], t[1], t[2]};
}

static void environment_forward(nn_step *step)
{
    cpu_environment in = environment_tensors(step->in);
    cpu_shade_environment(&in, &step->in[3], &step->out);
}

static void environment_backward(nn_step *step)
{
    cpu_environment in = environment_tensors(step->in), gradients = environment_tensors(step->in_gradient);
    cpu_environment_accumulate accumulate = {step->accumulate[0], step->accumulate[1], step->accumulate[2]};
    cpu_environment_backward(&in, &step->in[3], &step->out_gradient, &gradients, accumulate);
}

/* The mean over the masks of all ranks, by whose sum the gradients are divided, too. */
static status sum_loss(nn_step *step)
{
    if (ranks_count(step->together) == 1) return OK;
    double sums[] = {(double)step->loss * step->mask_sum, step->mask_sum};
    status s = ranks_sum(step->together, sums, 2);
    step->loss = sums[1] > 0 ? (float)(sums[0] / sums[1]) : 0;
    step->mask_sum = sums[1];
    return s;
}

static status kernel_forward(nn_step *step)
{
    const nn_tensor *x = &step->in[0];
    const nn_attributes *at = &step->at;
    nn_tensor *y = &step->out;
    switch (step->op) {
    case OP_COMPUTE:
    case OP_FLOAT:
        cpu_cast(x, y, false);
        break;
    case OP_RELU:
        cpu_relu(x, y);
        break;
    case OP_TANH:
        cpu_tanh(x, y);
        break;
    case OP_SIGMOID:
        cpu_sigmoid(x, y);
        break;
    case OP_CONCAT:
        concat_forward(step);
        break;
    case OP_SLICE:
        cpu_extract_channels(x, at->first, y, false);
        break;
    case OP_ADD:
        cpu_add(x, &step->in[1], y);
        break;
    case OP_GATE:
        cpu_gate(x, &step->in[1], y);
        break;
    case OP_SCALE_SHIFT:
        cpu_scale_shift(x, y, at->scale, at->shift);
        break;
    case OP_UPSAMPLE_BILINEAR:
        cpu_upsample_bilinear(x, y);
        break;
    case OP_TILE:
        cpu_tile(x, y);
        break;
    case OP_SPACE_TO_DEPTH:
        cpu_space_to_depth(x, y, at->block, false);
        break;
    case OP_DEPTH_TO_SPACE:
        cpu_depth_to_space(x, y, at->block, false);
        break;
    case OP_SPATIAL_MEAN:
        cpu_spatial_mean(x, y);
        break;
    case OP_NORMALIZE:
        cpu_normalize(x, y);
        break;
    case OP_RECIPROCAL:
        cpu_reciprocal(x, y, at->scale, at->shift);
        break;
    case OP_RENDER:
        render_forward(step);
        break;
    case OP_ENVIRONMENT:
        environment_forward(step);
        break;
    case OP_MASKED_L2:
        step->loss = cpu_masked_l2(x, x + 1, x + 2, &step->mask_sum);
        return sum_loss(step);
    case OP_MASKED_GRADIENT_L2:
        step->loss = cpu_masked_gradient_l2(x, x + 1, x + 2, &step->mask_sum);
        return sum_loss(step);
    case OP_MASKED_DSSIM: {
        status s = cpu_masked_dssim(x, x + 1, x + 2, &step->mask_sum, &step->loss);
        return s == OK ? sum_loss(step) : s;
    }
    default:
        return fail(ERROR_DEVICE, "%s has no kernel", op_name(step->op));
    }
    return OK;
}

static status kernel_backward(nn_step *step)
{
    const nn_tensor *x = &step->in[0], *y = &step->out, *dy = &step->out_gradient;
    const nn_attributes *at = &step->at;
    nn_tensor *dx = &step->in_gradient[0];
    bool add = step->accumulate[0];
    switch (step->op) {
    case OP_COMPUTE:
    case OP_FLOAT:
        cpu_cast(dy, dx, add);
        break;
    case OP_RELU:
        cpu_relu_backward(y, dy, dx, add);
        break;
    case OP_TANH:
        cpu_tanh_backward(y, dy, dx, add);
        break;
    case OP_SIGMOID:
        cpu_sigmoid_backward(y, dy, dx, add);
        break;
    case OP_CONCAT:
        concat_backward(step);
        break;
    case OP_SLICE:
        slice_backward(step);
        break;
    case OP_ADD:
        add_backward(step);
        break;
    case OP_GATE:
        gate_backward(step);
        break;
    case OP_SCALE_SHIFT:
        cpu_scale_shift_backward(dy, dx, at->scale, add);
        break;
    case OP_UPSAMPLE_BILINEAR:
        cpu_upsample_bilinear_backward(dy, dx, add);
        break;
    case OP_TILE:
        cpu_tile_backward(dy, dx, add);
        break;
    case OP_SPACE_TO_DEPTH:
        cpu_depth_to_space(dy, dx, at->block, add);
        break;
    case OP_DEPTH_TO_SPACE:
        cpu_space_to_depth(dy, dx, at->block, add);
        break;
    case OP_SPATIAL_MEAN:
        cpu_spatial_mean_backward(dy, dx, add);
        break;
    case OP_NORMALIZE:
        cpu_normalize_backward(x, y, dy, dx, add);
        break;
    case OP_RECIPROCAL:
        cpu_reciprocal_backward(y, dy, dx, at->scale, add);
        break;
    case OP_RENDER:
        render_backward(step);
        break;
    case OP_ENVIRONMENT:
        environment_backward(step);
        break;
    case OP_MASKED_L2:
        cpu_masked_l2_backward(x, x + 1, x + 2, step->mask_sum, at->weight, dx, add);
        break;
    case OP_MASKED_GRADIENT_L2:
        cpu_masked_gradient_l2_backward(x, x + 1, x + 2, step->mask_sum, at->weight, dx, add);
        break;
    case OP_MASKED_DSSIM:
        return cpu_masked_dssim_backward(x, x + 1, x + 2, step->mask_sum, at->weight, dx, add);
    default:
        return fail(ERROR_DEVICE, "%s has no gradient", op_name(step->op));
    }
    return OK;
}

status kernel_create(nn_step *step)
{
    static const step_functions functions = {.forward = kernel_forward, .backward = kernel_backward};
    step->run = &functions;
    if (step->out.c > CPU_MAX_CHANNELS)
        return fail(ERROR_USAGE, "%d channels, the CPU's limit is %d", step->out.c, CPU_MAX_CHANNELS);
    return OK;
}
