/* SPDX-License-Identifier: MIT */
#include "nn/nn.h"

#include "tensors.h"

enum { WEIGHTS = 6, BIASES = 2 };

/* Makes one fully connected layer, 3 to 2: a weight and a bias. */
static nn_params *layer(void)
{
    nn_graph *g = nn_graph_new();
    nn_node *y = nn_linear(g, nn_compute(g, nn_input(g, "x", 3, NN_VECTOR)), "layer", BIASES);
    nn_output(g, y, "y");
    nn_params *params = NULL;
    assert_int_equal(nn_params_new(g, 1, &params), OK);
    nn_graph_free(g);
    return params;
}

static nn_adam *adam_for(nn_params *params, float clip)
{
    nn_adam_options options = {.beta1 = 0.9f, .beta2 = 0.999f, .epsilon = 1e-8f, .clip_norm = clip};
    nn_adam *adam = NULL;
    assert_int_equal(nn_adam_new(params, &options, &adam), OK);
    return adam;
}

static void set_gradients(nn_params *params, float weight, float bias)
{
    nn_param *w = nn_params_find(params, "layer.weight"), *b = nn_params_find(params, "layer.bias");
    assert_int_equal(w->count, WEIGHTS), assert_int_equal(b->count, BIASES);
    for (int i = 0; i < WEIGHTS; i++)
        w->gradient[i] = weight;
    for (int i = 0; i < BIASES; i++)
        b->gradient[i] = bias;
}

static float change(nn_params *params, const char *name, float before)
{
    return nn_params_find(params, name)->value[0] - before;
}

/* The first step is the rate against the gradient's sign, whatever its size: m̂ / √v̂ = g / |g|. */
static void the_first_step_is_the_learning_rate(void **state)
{
    (void)state;
    nn_params *params = layer();
    nn_adam *adam = adam_for(params, 0);
    float weight = nn_params_find(params, "layer.weight")->value[0];
    set_gradients(params, 0.25f, -1e-3f);
    assert_int_equal(nn_adam_step(adam, 0.01f), OK);
    /* 1e-5: (1 - β2) in float against 1 - β2^t in double, and the difference of nearby floats */
    assert_true(fabsf(change(params, "layer.weight", weight) + 0.01f) < 1e-5f * 0.01f + 1e-7f);
    assert_true(fabsf(change(params, "layer.bias", 0) - 0.01f) < 3e-5f * 0.01f + 1e-7f);
    assert_int_equal(nn_adam_steps(adam), 1);
    nn_adam_free(adam);
    nn_params_free(params);
}

/* Computed by hand for gradients 1, then 2 (β 0.9 and 0.999): m = 0.29, v = 0.004999, m̂ = 0.29/0.19, v̂ =
 * 0.004999/0.001999. */
static void the_second_step_is_as_computed_by_hand(void **state)
{
    (void)state;
    nn_params *params = layer();
    nn_adam *adam = adam_for(params, 0);
    set_gradients(params, 1, 1);
    assert_int_equal(nn_adam_step(adam, 0.1f), OK);
    float before = nn_params_find(params, "layer.bias")->value[0];
    set_gradients(params, 2, 2);
    assert_int_equal(nn_adam_step(adam, 0.1f), OK);
    double expected = -0.1 * (0.29 / 0.19) / sqrt(0.004999 / 0.001999);
    assert_true(fabs((double)change(params, "layer.bias", before) - expected) < 2e-5 * fabs(expected));
    for (size_t i = 0; i < nn_params_count(params); i++) {
        assert_true(fabsf(nn_adam_moment(adam, i, 1)[0] - 0.29f) < 1e-6f);
        /* 1 - 0.999 in float has a relative error of 1.3e-5 */
        assert_true(fabsf(nn_adam_moment(adam, i, 2)[0] - 0.004999f) < 1e-7f);
    }
    nn_adam_free(adam);
    nn_params_free(params);
}

static void the_rate_scale_of_a_parameter_counts(void **state)
{
    (void)state;
    nn_params *params = layer();
    nn_adam *adam = adam_for(params, 0);
    nn_params_scale_rate(params, "layer.bias", 2);
    float weight = nn_params_find(params, "layer.weight")->value[0];
    set_gradients(params, 1, 1);
    assert_int_equal(nn_adam_step(adam, 0.01f), OK);
    assert_true(fabsf(change(params, "layer.weight", weight) + 0.01f) < 1e-6f);
    assert_true(fabsf(change(params, "layer.bias", 0) + 0.02f) < 1e-6f);
    nn_adam_free(adam);
    nn_params_free(params);
}

/* Eight gradients of 3 have the norm √72; clipped to norm 1 each is 3/√72, and the first moment a tenth of that. */
static void gradients_are_clipped_by_their_global_norm(void **state)
{
    (void)state;
    nn_params *params = layer();
    nn_adam *adam = adam_for(params, 1);
    set_gradients(params, 3, 3);
    assert_int_equal(nn_adam_step(adam, 0.01f), OK);
    float expected = 0.1f * 3 / sqrtf(72);
    for (size_t i = 0; i < nn_params_count(params); i++)
        assert_true(fabsf(nn_adam_moment(adam, i, 1)[0] - expected) < 1e-6f);
    nn_adam_free(adam);
    nn_params_free(params);
}

static void smaller_gradients_are_not_clipped(void **state)
{
    (void)state;
    nn_params *params = layer();
    nn_adam *adam = adam_for(params, 100);
    set_gradients(params, 3, 3);
    assert_int_equal(nn_adam_step(adam, 0.01f), OK);
    assert_true(fabsf(nn_adam_moment(adam, 0, 1)[0] - 0.3f) < 1e-6f);
    nn_adam_free(adam);
    nn_params_free(params);
}

static void a_broken_gradient_changes_nothing_and_is_counted(void **state)
{
    (void)state;
    nn_params *params = layer();
    nn_adam *adam = adam_for(params, 1);
    static const float broken[] = {NAN, INFINITY, -INFINITY};
    nn_param *w = nn_params_find(params, "layer.weight");
    float before[WEIGHTS];
    memcpy(before, w->value, sizeof before);
    for (int i = 0; i < 3; i++) {
        set_gradients(params, 1, 1);
        w->gradient[4] = broken[i];
        assert_int_equal(nn_adam_step(adam, 0.01f), OK);
    }
    assert_memory_equal(before, w->value, sizeof before);
    assert_true(nn_adam_moment(adam, 0, 1)[0] == 0);
    assert_int_equal(nn_adam_steps(adam), 0);
    assert_int_equal(nn_adam_skipped(adam), 3);
    nn_adam_free(adam);
    nn_params_free(params);
}

/* Its second moment would be infinite, and the parameter would never change again. */
static void a_gradient_whose_square_overflows_changes_nothing(void **state)
{
    (void)state;
    nn_params *params = layer();
    nn_adam *adam = adam_for(params, 0);
    set_gradients(params, 1, 1e20f);
    assert_int_equal(nn_adam_step(adam, 0.01f), OK);
    assert_int_equal(nn_adam_skipped(adam), 1);
    set_gradients(params, 1, 1);
    assert_int_equal(nn_adam_step(adam, 0.01f), OK);
    assert_true(fabsf(change(params, "layer.bias", 0) + 0.01f) < 1e-6f);
    nn_adam_free(adam);
    nn_params_free(params);
}

/* Clipping comes before the square. */
static void a_large_gradient_that_is_clipped_is_taken(void **state)
{
    (void)state;
    nn_params *params = layer();
    nn_adam *adam = adam_for(params, 1);
    set_gradients(params, 0, 1e20f);
    assert_int_equal(nn_adam_step(adam, 0.01f), OK);
    assert_int_equal(nn_adam_skipped(adam), 0);
    assert_true(fabsf(change(params, "layer.bias", 0) + 0.01f) < 1e-6f);
    nn_adam_free(adam);
    nn_params_free(params);
}

/* A checkpoint's values, moments and counts suffice: a new optimizer continues with the same bits. */
static void a_restored_optimizer_goes_on_with_the_same_bits(void **state)
{
    (void)state;
    nn_params *params[2] = {layer(), layer()};
    nn_adam *adam[2] = {adam_for(params[0], 1), adam_for(params[1], 1)};
    for (int i = 0; i < 5; i++) {
        set_gradients(params[0], 0.1f * (float)i, -0.3f);
        assert_int_equal(nn_adam_step(adam[0], 0.01f), OK);
    }
    for (size_t i = 0; i < nn_params_count(params[0]); i++) {
        nn_param *from = nn_params_at(params[0], i), *to = nn_params_at(params[1], i);
        memcpy(to->value, from->value, from->count * sizeof(float));
        for (int m = 1; m <= 2; m++)
            memcpy(nn_adam_moment(adam[1], i, m), nn_adam_moment(adam[0], i, m), from->count * sizeof(float));
    }
    nn_adam_set_steps(adam[1], nn_adam_steps(adam[0]), nn_adam_skipped(adam[0]));
    for (int k = 0; k < 2; k++) {
        set_gradients(params[k], 0.7f, 0.2f);
        assert_int_equal(nn_adam_step(adam[k], 0.01f), OK);
    }
    for (size_t i = 0; i < nn_params_count(params[0]); i++) {
        nn_param *a = nn_params_at(params[0], i), *b = nn_params_at(params[1], i);
        assert_memory_equal(a->value, b->value, a->count * sizeof(float));
    }
    for (int k = 0; k < 2; k++)
        nn_adam_free(adam[k]), nn_params_free(params[k]);
}

/* Beside the step of the gradient, a weight loses the rate times the decay of itself. */
static void weights_decay_and_biases_do_not(void **state)
{
    (void)state;
    float after[2][2];
    for (int decays = 0; decays < 2; decays++) {
        nn_params *params = layer();
        nn_adam_options options = {0.9f, 0.999f, 1e-8f, 0, decays ? 0.5f : 0};
        nn_adam *adam = NULL;
        nn_param *weight = nn_params_find(params, "layer.weight"), *bias = nn_params_find(params, "layer.bias");
        weight->value[0] = bias->value[0] = 2;
        assert_int_equal(nn_adam_new(params, &options, &adam), OK);
        set_gradients(params, 0.25f, 0.25f);
        assert_int_equal(nn_adam_step(adam, 0.01f), OK);
        after[decays][0] = weight->value[0], after[decays][1] = bias->value[0];
        nn_adam_free(adam);
        nn_params_free(params);
    }
    assert_float_equal(after[0][0] - after[1][0], 0.01f * 0.5f * 2, 1e-6f);
    assert_float_equal(after[0][1], after[1][1], 0);
}

static void senseless_options_are_refused(void **state)
{
    (void)state;
    nn_params *params = layer();
    static const nn_adam_options wrong[] = {{1, 0.999f, 1e-8f, 0, 0},     {0.9f, -0.1f, 1e-8f, 0, 0},
                                            {0.9f, NAN, 1e-8f, 0, 0},     {0.9f, 0.999f, 0, 0, 0},
                                            {0.9f, 0.999f, 1e-8f, -1, 0}, {0.9f, 0.999f, 1e-8f, 0, -1},
                                            {0.9f, 0.999f, 1e-8f, 0, NAN}};
    nn_adam *adam = NULL;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(nn_adam_new(params, &wrong[i], &adam), MERLIN_WRONG_USE);
    adam = adam_for(params, 0);
    assert_int_equal(nn_adam_step(adam, -1), MERLIN_WRONG_USE);
    assert_int_equal(nn_adam_step(adam, NAN), MERLIN_WRONG_USE);
    nn_adam_free(adam);
    nn_params_free(params);
}

/* The tensors are larger than a thread's share, so that both loops run over several blocks. */
static void kernels_do_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    enum { COUNT = 40001 };
    cpu_tensor g = tensor_random(NN_FLOAT32, 1, 1, 1, COUNT, 1);
    adam_step step = {1e-3f, 0.9f, 0.999f, 1e-8f, 0.1f, 1e-3f, 0.5f, 0.9f};
    cpu_tensor v[2], m1[2], m2[2];
    double sum[2];
    int before = parallel_threads();
    for (int i = 0; i < 2; i++) {
        v[i] = tensor_random(NN_FLOAT32, 1, 1, 1, COUNT, 2), m1[i] = tensor_like(&g), m2[i] = tensor_like(&g);
        threads_use_here(i + 1);
        cpu_adam(&step, COUNT, v[i].data, g.data, m1[i].data, m2[i].data);
        sum[i] = cpu_sum_squares(g.data, COUNT);
    }
    threads_use_here(before);
    assert_same_bits("value", &v[0], &v[1]), assert_same_bits("moment", &m2[0], &m2[1]);
    assert_true(sum[0] == sum[1] && fabs(sum[0] - tensor_dot(&g, &g)) < 1e-9 * sum[0]);
    for (int i = 0; i < 2; i++)
        tensor_free(&v[i]), tensor_free(&m1[i]), tensor_free(&m2[i]);
    tensor_free(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_step_is_the_learning_rate),
        cmocka_unit_test(the_second_step_is_as_computed_by_hand),
        cmocka_unit_test(the_rate_scale_of_a_parameter_counts),
        cmocka_unit_test(gradients_are_clipped_by_their_global_norm),
        cmocka_unit_test(smaller_gradients_are_not_clipped),
        cmocka_unit_test(a_broken_gradient_changes_nothing_and_is_counted),
        cmocka_unit_test(a_gradient_whose_square_overflows_changes_nothing),
        cmocka_unit_test(a_large_gradient_that_is_clipped_is_taken),
        cmocka_unit_test(a_restored_optimizer_goes_on_with_the_same_bits),
        cmocka_unit_test(weights_decay_and_biases_do_not),
        cmocka_unit_test(senseless_options_are_refused),
        cmocka_unit_test(kernels_do_not_depend_on_the_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
