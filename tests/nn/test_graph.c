/* SPDX-License-Identifier: MIT */
/* The builder's checks, parameters, and the guarantees of a program beyond its results. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "nn/nn.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

static nn_node *compute_input(nn_graph *g, const char *name, int channels, int reduction)
{
    return nn_compute(g, nn_input(g, name, channels, reduction));
}

/* Frees the graph, whose error must contain these words. */
static void assert_refused(nn_graph *g, const char *words)
{
    nn_params *params;
    assert_int_equal(nn_params_new(g, 1, &params), MERLIN_WRONG_USE);
    if (!strstr(status_message(), words)) fail_msg("\"%s\" is not in \"%s\"", words, status_message());
    nn_graph_free(g);
}

static void duplicate_names_are_refused(void **state)
{
    (void)state;
    nn_graph *g = nn_graph_new();
    nn_node *x = compute_input(g, "x", 3, 1);
    x = nn_conv2d(g, x, "conv", 4, 3, 1, NN_BIAS);
    assert_null(nn_batch_norm(g, x, "conv"));
    assert_refused(g, "already taken");

    g = nn_graph_new();
    nn_input(g, "x", 3, 1);
    assert_null(nn_input(g, "x", 3, 1));
    assert_refused(g, "already taken");

    g = nn_graph_new();
    x = nn_input(g, "x", 3, 1);
    nn_output(g, x, "y");
    nn_output(g, x, "y");
    assert_refused(g, "already taken");
}

static void inputs_that_differ_are_refused(void **state)
{
    (void)state;
    nn_graph *g = nn_graph_new();
    nn_node *a = nn_input(g, "a", 3, 1), *b = nn_input(g, "b", 3, 2);
    assert_null(nn_concat(g, (nn_node *[]){a, b}, 2));
    assert_refused(g, "concat: inputs differ");

    g = nn_graph_new();
    a = nn_input(g, "a", 3, 1);
    assert_null(nn_add(g, a, nn_input(g, "b", 4, 1)));
    assert_refused(g, "add: inputs differ");

    g = nn_graph_new();
    a = nn_input(g, "a", 3, 1);
    assert_null(nn_add(g, a, compute_input(g, "b", 3, 1)));
    assert_refused(g, "compute");

    g = nn_graph_new();
    a = nn_input(g, "a", 3, 1);
    assert_null(nn_gate(g, a, nn_input(g, "b", 2, 1)));
    assert_refused(g, "2 channels");
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    nn_graph *g = nn_graph_new();
    assert_null(nn_conv2d(g, nn_input(g, "a", 3, 1), "c", 4, 3, 1, NN_BIAS));
    assert_refused(g, "nn_compute");

    g = nn_graph_new();
    assert_null(nn_slice(g, nn_input(g, "a", 3, 1), 2, 2));
    assert_refused(g, "slice");

    g = nn_graph_new();
    assert_null(nn_upsample_bilinear(g, nn_input(g, "a", 3, 1)));
    assert_refused(g, "cannot be enlarged");

    g = nn_graph_new();
    assert_null(nn_depth_to_space(g, nn_input(g, "a", 3, 2), 2));
    assert_refused(g, "depth_to_space");

    g = nn_graph_new();
    assert_null(nn_linear(g, compute_input(g, "a", 3, 1), "fc", 4));
    assert_refused(g, "not a vector");

    g = nn_graph_new();
    assert_null(nn_normalize(g, nn_input(g, "a", 4, 1)));
    assert_refused(g, "normalize");
}

static void pictures_and_objects_are_kept_apart(void **state)
{
    (void)state;
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_input(g, "x", 6, 1);
    assert_null(nn_concat(g, (nn_node *[]){x, nn_group_mean(g, x, NULL)}, 2));
    assert_refused(g, "of pictures and of objects");

    g = nn_graph_new();
    assert_null(nn_group_max(g, nn_group_input(g, "x", 6, 1), NULL));
    assert_refused(g, "of objects already");

    g = nn_graph_new();
    assert_null(nn_group_repeat(g, nn_input(g, "x", 6, 1)));
    assert_refused(g, "of pictures already");

    g = nn_graph_new();
    x = nn_input(g, "x", 6, 1);
    assert_null(nn_group_mean(g, x, x));
    assert_refused(g, "float vector of 1 channel");

    g = nn_graph_new();
    assert_null(nn_group_attention(g, nn_input(g, "x", 12, 1), NULL, 3));
    assert_refused(g, "3 parts of 3 heads");

    g = nn_graph_new();
    assert_null(nn_group_pool(g, nn_input(g, "x", 4 * NN_LARGEST_HEAD, 1), NULL, "pool", 1));
    assert_refused(g, "at most 64 channels");
}

static void points_have_no_neighbours(void **state)
{
    (void)state;
    nn_graph *g = nn_graph_new();
    assert_null(nn_conv2d(g, compute_input(g, "x", 3, NN_POINTS), "conv", 4, 3, 1, NN_BIAS));
    assert_refused(g, "no neighbours");

    g = nn_graph_new();
    assert_null(nn_upsample_bilinear(g, nn_input(g, "x", 3, NN_POINTS)));
    assert_refused(g, "cannot be enlarged");

    g = nn_graph_new();
    nn_node *x = nn_input(g, "x", 1, NN_POINTS);
    nn_masked_dssim(g, x, x, x, "loss", 1);
    assert_refused(g, "not an image");

    g = nn_graph_new();
    assert_null(nn_gather(g, nn_input(g, "x", 3, 1), nn_input(g, "places", 2, NN_VECTOR)));
    assert_refused(g, "NN_POINTS");

    g = nn_graph_new();
    assert_null(nn_gather(g, nn_group_input(g, "x", 3, 1), nn_input(g, "places", 2, NN_POINTS)));
    assert_refused(g, "places are of pictures");
}

static void the_first_error_is_reported_and_null_passes_quietly(void **state)
{
    (void)state;
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_slice(g, nn_input(g, "a", 3, 1), 5, 1);
    x = nn_relu(g, nn_batch_norm(g, nn_conv2d(g, nn_compute(g, x), "c", 4, 3, 1, NN_BIAS), "bn"));
    assert_null(nn_concat(g, (nn_node *[]){x, x}, 2));
    nn_output(g, x, "y");
    assert_refused(g, "slice: channels 5 to 6 of 3");
}

static nn_graph *small_net(void)
{
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_space_to_depth(g, compute_input(g, "image", 3, 1), 2);
    x = nn_relu(g, nn_batch_norm(g, nn_conv2d(g, x, "conv1", 8, 3, 1, NN_NO_BIAS), "bn1"));
    x = nn_depth_to_space(g, nn_upsample_bilinear(g, nn_conv2d(g, x, "conv2", 12, 3, 2, NN_BIAS)), 2);
    nn_output(g, x, "out");
    nn_input(g, "unused", 2, NN_VECTOR);
    nn_masked_l2(g, nn_float(g, x), nn_input(g, "target", 3, 1), nn_input(g, "mask", 1, 1), "l2", 0.5f);
    return g;
}

static void parameters_have_pytorch_shapes(void **state)
{
    (void)state;
    nn_graph *g = small_net();
    nn_params *params;
    assert_int_equal(nn_params_new(g, 7, &params), OK);
    assert_int_equal(nn_params_count(params), 1 + 4 + 2);
    const nn_param *w = nn_params_find(params, "conv1.weight");
    assert_memory_equal(w->shape, ((int64_t[]){8, 12, 3, 3}), sizeof w->shape);
    assert_null(nn_params_find(params, "bn1.running_var")->gradient);
    assert_float_equal(nn_params_find(params, "bn1.running_var")->value[3], 1, 0);
    assert_float_equal(nn_params_find(params, "bn1.weight")->value[3], 1, 0);
    assert_null(nn_params_find(params, "conv1.bias"));
    nn_params_scale_rate(params, "bn1.", 0.5f);
    assert_float_equal(nn_params_find(params, "bn1.bias")->learning_rate_scale, 0.5f, 0);
    assert_float_equal(w->learning_rate_scale, 1, 0);
    nn_params_free(params);
    nn_graph_free(g);
}

static void first_weights_depend_on_seed_and_name_alone(void **state)
{
    (void)state;
    nn_graph *g = nn_graph_new();
    nn_node *x = compute_input(g, "x", 64, 1);
    nn_node *a = nn_conv2d(g, x, "a", 64, 3, 1, NN_BIAS);
    nn_conv2d(g, a, "b", 64, 3, 1, NN_BIAS);
    nn_graph *other = nn_graph_new();
    nn_conv2d(other, compute_input(other, "x", 64, 1), "b", 64, 3, 1, NN_BIAS);
    nn_params *p, *q;
    assert_int_equal(nn_params_new(g, 5, &p), OK);
    assert_int_equal(nn_params_new(other, 5, &q), OK);
    const nn_param *pb = nn_params_find(p, "b.weight"), *qb = nn_params_find(q, "b.weight");
    assert_memory_equal(pb->value, qb->value, pb->count * sizeof(float));
    assert_memory_not_equal(pb->value, nn_params_find(p, "a.weight")->value, pb->count * sizeof(float));
    double square = 0;
    for (size_t i = 0; i < pb->count; i++)
        square += (double)(pb->value[i] * pb->value[i]);
    /* He: 2 / (64·9); the mean square of 36864 normals deviates by √(2/36864) = 0.7 %, five times that is allowed */
    assert_true(fabs(square / (double)pb->count * 64 * 9 / 2 - 1) < 0.037);
    nn_params_free(p);
    nn_params_free(q);
    nn_graph_free(g);
    nn_graph_free(other);
}

static void sizes_that_do_not_divide_are_refused(void **state)
{
    (void)state;
    nn_graph *g = small_net();
    nn_params *params;
    nn_program *p;
    assert_int_equal(nn_params_new(g, 7, &params), OK);
    assert_int_equal(nn_compile(g, params, &(nn_options){.batch = 1, .height = 18, .width = 16}, &p), MERLIN_WRONG_USE);
    assert_null(p);
    assert_non_null(strstr(status_message(), "multiple"));
    assert_int_equal(nn_compile(g, params, &(nn_options){.batch = 0, .height = 16, .width = 16}, &p), MERLIN_WRONG_USE);
    nn_params_free(params);
    nn_graph_free(g);
}

static void batches_that_are_no_whole_objects_are_refused(void **state)
{
    (void)state;
    nn_graph *g = nn_graph_new();
    nn_output(g, nn_gather(g, nn_input(g, "x", 3, 1), nn_input(g, "places", 2, NN_POINTS)), "y");
    nn_params *params;
    nn_program *p;
    assert_int_equal(nn_params_new(g, 7, &params), OK);
    nn_options wrong[] = {{.batch = 4, .group = 3, .points = 1}, {.batch = 65, .group = 65, .points = 1}, {.batch = 4}};
    static const char *const words[] = {"3 of each object", "up to 64", "there are none"};
    for (int i = 0; i < 3; i++) {
        wrong[i].height = wrong[i].width = 8;
        assert_int_equal(nn_compile(g, params, &wrong[i], &p), MERLIN_WRONG_USE);
        assert_non_null(strstr(status_message(), words[i]));
    }
    nn_params_free(params);
    nn_graph_free(g);
}

static void parameters_of_another_graph_are_refused(void **state)
{
    (void)state;
    nn_graph *g = small_net(), *other = nn_graph_new();
    nn_conv2d(other, compute_input(other, "x", 3, 1), "conv1", 8, 3, 1, NN_NO_BIAS);
    nn_params *params;
    nn_program *p;
    assert_int_equal(nn_params_new(other, 7, &params), OK);
    assert_int_equal(nn_compile(g, params, &(nn_options){.batch = 1, .height = 16, .width = 16}, &p), MERLIN_WRONG_USE);
    assert_non_null(strstr(status_message(), "conv1"));
    nn_params_free(params);
    nn_graph_free(g);
    nn_graph_free(other);
}

static void a_program_outlives_its_graph(void **state)
{
    (void)state;
    nn_graph *g = small_net();
    nn_params *params;
    nn_program *p;
    assert_int_equal(nn_params_new(g, 7, &params), OK);
    const nn_options options = {.batch = 2, .height = 16, .width = 8, .purpose = NN_TRAIN};
    assert_int_equal(nn_compile(g, params, &options, &p), OK);
    nn_graph_free(g);
    assert_int_equal(nn_backward(p), MERLIN_WRONG_USE);
    assert_non_null(nn_input_data(p, "unused"));
    assert_null(nn_input_data(p, "nothing"));
    assert_null(nn_output_data(p, "nothing"));
    for (int i = 0; i < 2 * 16 * 8; i++)
        nn_input_data(p, "mask")[i] = 1;
    assert_int_equal(nn_forward(p), OK);
    assert_int_equal(nn_backward(p), OK);
    assert_true(isnan(nn_loss(p, "nothing")));
    assert_float_equal(nn_total_loss(p), 0.5f * nn_loss(p, "l2"), 1e-6f * nn_loss(p, "l2"));
    nn_program_free(p);
    nn_params_free(params);
}

static void cost_counts_two_per_multiply_add(void **state)
{
    (void)state;
    nn_graph *g = small_net();
    nn_params *params;
    nn_program *p;
    assert_int_equal(nn_params_new(g, 7, &params), OK);
    const nn_options options = {.batch = 2, .height = 16, .width = 8, .purpose = NN_TRAIN};
    assert_int_equal(nn_compile(g, params, &options, &p), OK);
    nn_cost cost = nn_program_cost(p);
    double conv1 = 2.0 * 2 * 8 * 4 * 8 * 12 * 9, conv2 = 2.0 * 2 * 4 * 2 * 12 * 8 * 9;
    assert_float_equal(cost.forward_flops, conv1 + conv2, 0.5);
    assert_float_equal(cost.backward_flops, conv1 + 2 * conv2, 0.5); /* the image needs no gradient */
    assert_int_equal(cost.parameter_count, 8 * 12 * 9 + 16 + 12 * 8 * 9 + 12);
    nn_program_free(p);
    nn_params_free(params);
    nn_graph_free(g);
}

/* Builds two heads on one body; `options.outputs` chooses. */
static nn_graph *two_headed_net(void)
{
    nn_graph *g = nn_graph_new();
    nn_node *body = nn_relu(g, nn_conv2d(g, compute_input(g, "image", 3, 1), "body", 8, 3, 1, NN_BIAS));
    nn_output(g, nn_float(g, nn_conv2d(g, body, "left", 2, 3, 1, NN_BIAS)), "left");
    nn_output(g, nn_float(g, nn_conv2d(g, nn_conv2d(g, body, "neck", 8, 3, 1, NN_BIAS), "right", 4, 3, 1, NN_BIAS)),
              "right");
    return g;
}

static nn_program *compile_heads(nn_params *params, const nn_graph *g, const char *const *outputs,
                                 const nn_program *beside)
{
    nn_program *p;
    const nn_options options = {
        .batch = 1, .height = 8, .width = 8, .purpose = NN_INFER, .outputs = outputs, .beside = beside};
    assert_int_equal(nn_compile(g, params, &options, &p), OK);
    return p;
}

static void run_on_sines(nn_program *p, float frequency)
{
    float *image = nn_input_data(p, "image");
    for (int i = 0; i < 8 * 8 * 3; i++)
        image[i] = sinf(frequency * (float)i);
    assert_int_equal(nn_forward(p), OK);
}

static nn_program *run_heads(nn_params *params, const nn_graph *g, const char *const *outputs)
{
    nn_program *p = compile_heads(params, g, outputs, NULL);
    run_on_sines(p, 1);
    return p;
}

static void outputs_that_nobody_wants_are_left_out(void **state)
{
    (void)state;
    static const char *const left[] = {"left", NULL};
    nn_graph *g = two_headed_net();
    nn_params *params;
    assert_int_equal(nn_params_new(g, 3, &params), OK);
    nn_program *all = run_heads(params, g, NULL), *one = run_heads(params, g, left);
    assert_non_null(nn_output_data(all, "right"));
    assert_null(nn_output_data(one, "right"));
    assert_memory_equal(nn_output_data(one, "left"), nn_output_data(all, "left"), 8 * 8 * 2 * sizeof(float));
    assert_float_equal(nn_program_cost(one).forward_flops, 2.0 * 64 * 9 * (3 * 8 + 8 * 2), 0.5);
    nn_program_free(all);
    nn_program_free(one);
    nn_params_free(params);
    nn_graph_free(g);
}

/* Tells whether a run of one program changes the inputs or outputs of the other. */
static bool shares_memory(nn_program *one, nn_program *other)
{
    enum { SEEN = 8 * 8 * 3, SAID = 8 * 8 * 2 };
    float seen[SEEN], said[SAID];
    run_on_sines(one, 0.3f);
    memcpy(seen, nn_input_data(one, "image"), sizeof seen);
    memcpy(said, nn_output_data(one, "left"), sizeof said);
    run_on_sines(other, 2);
    return memcmp(seen, nn_input_data(one, "image"), sizeof seen) != 0 ||
           memcmp(said, nn_output_data(one, "left"), sizeof said) != 0;
}

/* The programs run in turns, each on a picture of its own; then the one that came first is freed first. */
static void programs_beside_each_other_share_memory(void **state)
{
    (void)state;
    enum { RUNS = 3, VALUES = 8 * 8 * 2 };
    static const char *const left[] = {"left", NULL};
    nn_graph *g = two_headed_net();
    nn_params *params;
    assert_int_equal(nn_params_new(g, 3, &params), OK);
    nn_program *alone = compile_heads(params, g, NULL, NULL), *all = compile_heads(params, g, NULL, NULL);
    nn_program *one = compile_heads(params, g, left, all);
    assert_true(shares_memory(one, all));
    for (int run = 0; run < RUNS; run++) {
        run_on_sines(all, 0.7f);
        run_on_sines(one, (float)(run + 1));
        run_on_sines(alone, (float)(run + 1));
        assert_memory_equal(nn_output_data(one, "left"), nn_output_data(alone, "left"), VALUES * sizeof(float));
    }
    nn_program_free(all);
    run_on_sines(one, 5);
    run_on_sines(alone, 5);
    assert_memory_equal(nn_output_data(one, "left"), nn_output_data(alone, "left"), VALUES * sizeof(float));
    nn_program *larger = compile_heads(params, g, NULL, one); /* needs as much as the first one has */
    assert_true(shares_memory(one, larger));
    nn_program *least = compile_heads(params, g, left, NULL), *most = compile_heads(params, g, NULL, least);
    assert_true(nn_program_cost(most).activation_bytes > nn_program_cost(least).activation_bytes);
    assert_false(shares_memory(least, most)); /* it has too little */
    nn_program *programs[] = {alone, one, larger, least, most};
    for (size_t i = 0; i < sizeof programs / sizeof programs[0]; i++)
        nn_program_free(programs[i]);
    nn_params_free(params);
    nn_graph_free(g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(duplicate_names_are_refused),
        cmocka_unit_test(inputs_that_differ_are_refused),
        cmocka_unit_test(wrong_arguments_are_refused),
        cmocka_unit_test(pictures_and_objects_are_kept_apart),
        cmocka_unit_test(points_have_no_neighbours),
        cmocka_unit_test(the_first_error_is_reported_and_null_passes_quietly),
        cmocka_unit_test(parameters_have_pytorch_shapes),
        cmocka_unit_test(first_weights_depend_on_seed_and_name_alone),
        cmocka_unit_test(sizes_that_do_not_divide_are_refused),
        cmocka_unit_test(batches_that_are_no_whole_objects_are_refused),
        cmocka_unit_test(parameters_of_another_graph_are_refused),
        cmocka_unit_test(a_program_outlives_its_graph),
        cmocka_unit_test(cost_counts_two_per_multiply_add),
        cmocka_unit_test(outputs_that_nobody_wants_are_left_out),
        cmocka_unit_test(programs_beside_each_other_share_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
