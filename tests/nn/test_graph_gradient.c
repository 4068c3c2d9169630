/* SPDX-License-Identifier: MIT */
/* A net of every operation: its gradients against finite differences, repeatability bit for bit, sizes and types. */
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <setjmp.h>

#include "base/rng.h"
#include "nn/lower.h"
#include "nn/nn_program.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

/* Adds to what the net sees of each picture what its object's pictures have in common. */
static nn_node *share(nn_graph *g, nn_node *x)
{
    nn_node *present = nn_input(g, "present", 1, NN_VECTOR);
    nn_node *seen = nn_group_attention(g, nn_conv2d(g, x, "attention", 24, 1, 1, NN_BIAS), present, 2);
    seen = nn_layer_norm(g, seen, "attention.norm");
    nn_node *pooled = nn_group_pool(g, nn_conv2d(g, seen, "pooled", 12, 1, 1, NN_BIAS), present, "pool", 2);
    nn_node *common[] = {nn_group_max(g, x, present), nn_group_mean(g, x, present), nn_group_spread(g, x, present),
                         pooled};
    nn_node *joined = nn_conv2d(g, nn_concat(g, common, 4), "common", 4, 1, 1, NN_BIAS);
    return nn_concat(g, (nn_node *[]){x, seen, nn_group_repeat(g, joined)}, 3);
}

/* Adds a loss at sampled points. */
static void sample(nn_graph *g, nn_node *map)
{
    nn_node *target = nn_input(g, "point_target", 3, NN_POINTS), *mask = nn_input(g, "point_mask", 1, NN_POINTS);
    nn_node *points = nn_compute(g, nn_gather(g, map, nn_group_input(g, "places", 2, NN_POINTS)));
    points = nn_float(g, nn_tanh(g, nn_conv2d(g, points, "points", 3, 1, 1, NN_BIAS)));
    nn_masked_l2(g, points, target, mask, "points", 0.5f);
}

/* Builds a net that is smooth except for one ReLU and the rendering layer's clipping, with every value used in several
 * ways. */
static nn_graph *build_net(void)
{
    nn_graph *g = nn_graph_new();
    nn_node *image = nn_input(g, "image", 3, 1), *mask = nn_input(g, "mask", 1, 1);
    nn_node *light = nn_input(g, "light", 3, NN_VECTOR);
    nn_node *x = nn_space_to_depth(g, nn_compute(g, nn_concat(g, (nn_node *[]){image, mask}, 2)), 2);
    nn_node *fine = nn_tanh(g, nn_batch_norm(g, nn_conv2d(g, x, "fine", 12, 3, 1, NN_NO_BIAS), "fine.bn"));
    nn_node *coarse = nn_sigmoid(g, nn_conv2d(g, fine, "coarse", 10, 3, 2, NN_BIAS));
    nn_node *code = nn_tanh(g, nn_linear(g, nn_compute(g, light), "light1", 6));
    code = nn_tile(g, nn_linear(g, code, "light2", 5), coarse);
    nn_node *folded = nn_space_to_depth(g, nn_slice(g, fine, 2, 2), 2);
    nn_node *deep = nn_concat(g, (nn_node *[]){coarse, code, nn_slice(g, coarse, 3, 4), folded}, 4);
    nn_node *up = nn_upsample_bilinear(g, nn_conv2d(g, deep, "up", 12, 1, 1, NN_BIAS));
    up = nn_add(g, up, nn_conv2d_transposed(g, deep, "transposed", 12, 4, 2));
    nn_node *gate = nn_sigmoid(g, nn_conv2d(g, nn_upsample_bilinear(g, deep), "gate", 1, 1, 1, NN_BIAS));
    nn_node *joined = nn_add(g, up, nn_gate(g, fine, gate));
    nn_node *block = nn_relu(g, nn_batch_norm(g, nn_conv2d(g, joined, "block", 12, 3, 1, NN_NO_BIAS), "block.bn"));
    joined = nn_add(g, block, joined);
    sample(g, joined);
    nn_node *head = nn_float(g, nn_conv2d(g, share(g, joined), "head", 32, 3, 1, NN_BIAS));
    head = nn_depth_to_space(g, head, 2);
    nn_node *albedo = nn_tanh(g, nn_slice(g, head, 0, 3));
    nn_node *slope = nn_tanh(g, nn_slice(g, head, 3, 2));
    nn_node *toward = nn_relu(g, nn_scale_shift(g, nn_tanh(g, nn_slice(g, head, 5, 1)), 0.2f, 2));
    nn_node *normal = nn_normalize(g, nn_concat(g, (nn_node *[]){slope, toward}, 2));
    nn_node *roughness = nn_tanh(g, nn_slice(g, head, 6, 1));
    nn_node *depth = nn_reciprocal(g, nn_tanh(g, nn_slice(g, head, 7, 1)), 0.4f, 0.65f);
    nn_node *radiance =
        nn_render(g, &(nn_render_inputs){albedo, normal, roughness, depth, mask, light, NULL}, 60, 5.95f);
    nn_node *mean = nn_compute(g, nn_spatial_mean(g, nn_float(g, coarse)));
    mean = nn_tanh(g, nn_linear(g, mean, "mean", 27));
    nn_node *ambient = nn_environment(g, albedo, normal, mask, nn_float(g, mean));
    radiance = nn_add(g, radiance, ambient);
    nn_output(g, radiance, "radiance");
    nn_output(g, joined, "joined");
    nn_masked_l2(g, albedo, nn_stop(g, image), mask, "albedo", 1);
    nn_masked_l2(g, normal, image, mask, "normal", 0.5f);
    nn_masked_l2(g, radiance, image, mask, "radiance", 2);
    nn_masked_gradient_l2(g, roughness, mask, mask, "roughness_gradient", 0.7f);
    nn_masked_gradient_l2(g, depth, mask, mask, "depth_gradient", 0.3f);
    nn_masked_dssim(g, radiance, image, mask, "radiance_ssim", 0.5f);
    return g;
}

static void fill(float *x, size_t count, uint64_t stream, float low, float high)
{
    rng random = rng_at(23, 0, stream);
    for (size_t i = 0; i < count; i++)
        x[i] = rng_range(&random, low, high);
}

static void fill_inputs(nn_program *p, const nn_options *o)
{
    size_t pixels = (size_t)o->batch * (size_t)o->height * (size_t)o->width;
    fill(nn_input_data(p, "image"), pixels * 3, 1, 0, 0.8f);
    fill(nn_input_data(p, "mask"), pixels, 2, 0, 1.8f);
    for (size_t i = 0; i < pixels; i++)
        nn_input_data(p, "mask")[i] = nn_input_data(p, "mask")[i] > 0.5f;
    fill(nn_input_data(p, "light"), (size_t)o->batch * 3, 3, -0.3f, 0.3f);
    const size_t batch = (size_t)o->batch, points = batch * (size_t)o->points;
    for (size_t i = 0; i < batch; i++)
        nn_input_data(p, "present")[i] = i != 1; /* one picture is left out if there are several */
    fill(nn_input_data(p, "places"), 2 * points / (size_t)(o->group ? o->group : 1), 4, -1, 8);
    fill(nn_input_data(p, "point_target"), 3 * points, 5, -0.5f, 0.5f);
    fill(nn_input_data(p, "point_mask"), points, 6, 0.1f, 1);
}

static nn_program *compile_net(nn_params **params, const nn_options *options)
{
    nn_graph *g = build_net();
    nn_program *p;
    if (!*params && nn_params_new(g, 3, params) != OK) fail_msg("%s", status_message());
    if (nn_compile(g, *params, options, &p) != OK) fail_msg("%s", status_message());
    nn_graph_free(g);
    fill_inputs(p, options);
    return p;
}

static double loss_at(nn_program *p, nn_params *params)
{
    nn_params_touch(params);
    assert_int_equal(nn_forward(p), OK);
    return (double)nn_total_loss(p);
}

/* Returns the slope of the loss along a direction by central differences, with the h⁴ term of Richardson. */
static double slope(nn_program *p, nn_params *params, nn_param *q, const float *direction, float h)
{
    float *kept = malloc(q->count * sizeof *kept);
    memcpy(kept, q->value, q->count * sizeof *kept);
    double loss[4];
    static const float steps[4] = {-2, -1, 1, 2};
    for (int k = 0; k < 4; k++) {
        for (size_t i = 0; i < q->count; i++)
            q->value[i] = kept[i] + steps[k] * h * direction[i];
        loss[k] = loss_at(p, params);
    }
    memcpy(q->value, kept, q->count * sizeof *kept);
    nn_params_touch(params);
    free(kept);
    return (8 * (loss[2] - loss[1]) - (loss[3] - loss[0])) / (12 * (double)h);
}

/* Along the gradient the slope is its length. The total loss is near 3 and a float (rounding 1.2e-7): with steps of
 * 5e-4 along unit directions slopes have an error of about 1e-3. Larger steps cross ReLU's kinks and clipping; their
 * remaining effect is within 1 %. */
static void gradients_match_finite_differences(void **state)
{
    (void)state;
    nn_params *params = NULL;
    const nn_options options = {.batch = 4, .height = 8, .width = 8, .group = 2, .points = 5, .purpose = NN_TRAIN};
    nn_program *p = compile_net(&params, &options);
    for (size_t i = 0; i < nn_params_count(params); i++) {
        nn_param *q = nn_params_at(params, i);
        if (!q->gradient) continue;
        loss_at(p, params);
        assert_int_equal(nn_backward(p), OK);
        double length = 0;
        for (size_t k = 0; k < q->count; k++)
            length += (double)(q->gradient[k] * q->gradient[k]);
        length = sqrt(length);
        float *direction = malloc(q->count * sizeof *direction);
        for (size_t k = 0; k < q->count; k++)
            direction[k] = (float)((double)q->gradient[k] / (length + 1e-12));
        double measured = slope(p, params, q, direction, 5e-4f);
        free(direction);
        if (!(fabs(measured - length) < 0.01 * length + 3e-3))
            fail_msg("%s: gradient %g, finite difference %g", q->name, length, measured);
    }
    nn_program_free(p);
    nn_params_free(params);
}

/* Each operation must pass a gradient, unless that is its purpose, and be a step of its own. */
static void the_net_has_every_operation(void **state)
{
    (void)state;
    nn_graph *g = build_net();
    const nn_options options = {
        .batch = 4, .height = 8, .width = 8, .group = 2, .points = 5, .type = NN_BFLOAT16, .purpose = NN_TRAIN};
    lowering low;
    assert_int_equal(lower_graph(g, &options, &low), OK);
    bool seen[OP_COUNT] = {[OP_INPUT] = true};
    for (int i = 0; i < low.step_count; i++) {
        const nn_op op = low.values[low.steps[i].head].node->op;
        if (op_is_loss(op) || !op_passes_gradient(op, 0) || low.values[low.steps[i].result].differentiable)
            seen[op] = true;
    }
    for (nn_op op = 0; op < OP_COUNT; op++)
        if (!seen[op]) fail_msg("%s is missing", op_name(op));
    lowering_free(&low);
    nn_graph_free(g);
}

/* Runs a step's backward with NaN in place of what it declares not to read. */
static void backward_without(nn_step *step, void *nan)
{
    void *in[NN_MAX_INPUTS], *out = step->out.data;
    for (int k = 0; k < step->inputs; k++) {
        in[k] = step->in[k].data;
        if (!step->reads_in) step->in[k].data = nan;
    }
    if (!step->reads_out) step->out.data = nan;
    assert_int_equal(step->run->backward(step), OK);
    for (int k = 0; k < step->inputs; k++)
        step->in[k].data = in[k];
    step->out.data = out;
}

/* Others may overwrite whatever is not kept for it, though in this net they do not. */
static void backward_reads_only_what_is_kept_for_it(void **state)
{
    (void)state;
    for (nn_type type = NN_FLOAT32; type <= NN_BFLOAT16; type++) {
        nn_params *params = NULL;
        const nn_options options = {
            .batch = 4, .height = 8, .width = 8, .group = 2, .points = 5, .type = type, .purpose = NN_TRAIN};
        nn_program *p = compile_net(&params, &options);
        size_t bytes = params->gradient_count * sizeof(float);
        float *expected = malloc(bytes);
        void *nan = malloc(p->arena_bytes);
        memset(nan, 0xff, p->arena_bytes);
        assert_int_equal(nn_forward(p), OK);
        assert_int_equal(nn_backward(p), OK);
        memcpy(expected, params->gradients, bytes);
        assert_int_equal(nn_forward(p), OK);
        p->device->begin(p->context);
        for (int i = p->step_count; i-- > 0;)
            if (p->steps[i].backs) backward_without(&p->steps[i], nan);
        p->device->end(p->context);
        assert_memory_equal(params->gradients, expected, bytes);
        free(expected);
        free(nan);
        nn_program_free(p);
        nn_params_free(params);
    }
}

static void training_steps(nn_type type, int steps, nn_params **params)
{
    *params = NULL;
    const nn_options options = {
        .batch = 4, .height = 16, .width = 8, .group = 2, .points = 5, .type = type, .purpose = NN_TRAIN};
    nn_program *p = compile_net(params, &options);
    for (int s = 0; s < steps; s++) {
        assert_int_equal(nn_forward(p), OK);
        assert_int_equal(nn_backward(p), OK);
        for (size_t i = 0; i < nn_params_count(*params); i++) {
            nn_param *q = nn_params_at(*params, i);
            for (size_t k = 0; q->gradient && k < q->count; k++)
                q->value[k] -= 1e-3f * q->gradient[k];
        }
        nn_params_touch(*params);
    }
    nn_program_free(p);
}

static void training_is_reproducible_to_the_bit(void **state)
{
    (void)state;
    for (nn_type type = NN_FLOAT32; type <= NN_BFLOAT16; type++) {
        nn_params *a, *b;
        training_steps(type, 4, &a);
        training_steps(type, 4, &b);
        for (size_t i = 0; i < nn_params_count(a); i++) {
            const nn_param *p = nn_params_at(a, i), *q = nn_params_at(b, i);
            assert_memory_equal(p->value, q->value, p->count * sizeof(float));
        }
        nn_params_free(a);
        nn_params_free(b);
    }
}

/* Returns the distance of two programs' outputs, relative to the second's root mean square. */
static double distance(const float *a, const float *b, size_t count)
{
    double error = 0, square = 0;
    for (size_t i = 0; i < count; i++) {
        error += pow((double)a[i] - (double)b[i], 2);
        square += pow((double)b[i], 2);
    }
    return sqrt(error / square);
}

static void programs_of_several_sizes_and_types_share_parameters(void **state)
{
    (void)state;
    nn_params *params = NULL;
    nn_options options = {.batch = 3, .height = 16, .width = 16, .points = 5};
    nn_program *three = compile_net(&params, &options);
    options.batch = 1;
    nn_program *one = compile_net(&params, &options);
    options.type = NN_BFLOAT16;
    nn_program *low = compile_net(&params, &options);
    assert_int_equal(nn_forward(three), OK);
    assert_int_equal(nn_forward(one), OK);
    assert_int_equal(nn_forward(low), OK);
    size_t count = 8 * 8 * 12;
    /* other shapes, other order of sums: some float32 roundings; bfloat16: ten roundings of 2^-9 in a row */
    assert_true(distance(nn_output_data(three, "joined"), nn_output_data(one, "joined"), count) < 1e-5);
    assert_true(distance(nn_output_data(low, "joined"), nn_output_data(one, "joined"), count) < 0.02);
    nn_program_free(three);
    nn_program_free(one);
    nn_program_free(low);
    nn_params_free(params);
}

static void inference_needs_less_memory_than_training(void **state)
{
    (void)state;
    nn_params *params = NULL;
    nn_options options = {.batch = 4, .height = 64, .width = 64, .points = 5};
    nn_program *infer = compile_net(&params, &options);
    options.purpose = NN_TRAIN;
    nn_program *train = compile_net(&params, &options);
    assert_true(2 * nn_program_cost(infer).activation_bytes < nn_program_cost(train).activation_bytes);
    nn_program_free(infer);
    nn_program_free(train);
    nn_params_free(params);
}

static void gradients_of_losses_that_are_not_built_are_zero(void **state)
{
    (void)state;
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_compute(g, nn_input(g, "x", 3, 1));
    nn_node *y = nn_conv2d(g, x, "y", 4, 3, 1, NN_BIAS), *z = nn_conv2d(g, x, "z", 4, 3, 1, NN_BIAS);
    nn_output(g, y, "y");
    nn_masked_l2(g, nn_float(g, z), nn_input(g, "t", 4, 1), nn_input(g, "m", 1, 1), "loss", 1);
    nn_params *params;
    nn_program *p;
    assert_int_equal(nn_params_new(g, 1, &params), OK);
    nn_param *q = nn_params_find(params, "y.weight"), *r = nn_params_find(params, "z.bias");
    q->gradient[7] = 5;
    assert_int_equal(nn_compile(g, params, &(nn_options){.batch = 1, .height = 8, .width = 8, .purpose = NN_TRAIN}, &p),
                     OK);
    fill(nn_input_data(p, "x"), 8 * 8 * 3, 1, 0, 1);
    fill(nn_input_data(p, "m"), 8 * 8, 1, 0, 1);
    assert_int_equal(nn_forward(p), OK);
    assert_int_equal(nn_backward(p), OK);
    assert_float_equal(q->gradient[7], 0, 0);
    assert_true(r->gradient[0] != 0);
    nn_program_free(p);
    nn_params_free(params);
    nn_graph_free(g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gradients_match_finite_differences),
        cmocka_unit_test(the_net_has_every_operation),
        cmocka_unit_test(backward_reads_only_what_is_kept_for_it),
        cmocka_unit_test(training_is_reproducible_to_the_bit),
        cmocka_unit_test(programs_of_several_sizes_and_types_share_parameters),
        cmocka_unit_test(inference_needs_less_memory_than_training),
        cmocka_unit_test(gradients_of_losses_that_are_not_built_are_zero),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
