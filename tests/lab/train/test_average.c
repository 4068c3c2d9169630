/* SPDX-License-Identifier: MIT */
#include <math.h>

#include "lab/train/average.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { STEPS = 400 };

static nn_params *new_params(nn_graph **graph)
{
    nn_params *params;
    *graph = nn_graph_new();
    nn_node *image = nn_input(*graph, "image", 4, 1);
    nn_output(*graph, nn_conv2d(*graph, nn_compute(*graph, image), "conv", 8, 3, 1, NN_BIAS), "out");
    assert_int_equal(nn_params_new(*graph, 1, &params), OK);
    return params;
}

static void set_all(nn_params *params, double value)
{
    for (size_t i = 0; i < nn_params_count(params); i++)
        for (size_t k = 0; k < nn_params_at(params, i)->count; k++)
            nn_params_at(params, i)->value[k] = (float)value;
}

static void all_equal(nn_params *params, double value, double tolerance)
{
    for (size_t i = 0; i < nn_params_count(params); i++)
        for (size_t k = 0; k < nn_params_at(params, i)->count; k++)
            assert_float_equal(nn_params_at(params, i)->value[k], value, tolerance);
}

static double swing(int step)
{
    return 1 + 0.1 * cos(0.7 * step);
}

static double line(int step)
{
    return step;
}

static double nothing(int step)
{
    (void)step;
    return 0;
}

/* Asserts the mean after the last step of weights that are 30 at first and then value(step). */
static void mean_is(double decay, double (*value)(int step), int steps, double expected, double tolerance)
{
    nn_graph *graph;
    nn_params *params = new_params(&graph);
    train_average *average;
    set_all(params, 30);
    assert_int_equal(train_average_new(params, decay, &average), OK);
    for (int step = 1; step <= steps; step++) {
        set_all(params, value(step));
        train_average_add(average, step, step == steps);
    }
    train_average_swap(average);
    all_equal(params, expected, tolerance);
    train_average_free(average);
    nn_params_free(params);
    nn_graph_free(graph);
}

/* Weights alternate about 1 from step to step, as those of a network about its optimum: the mean taken at every step is
 * 1 except for what is left of the start and half the amplitude of one step's share. */
static void mean_is_nearer_to_the_centre_than_any_step(void **state)
{
    (void)state;
    mean_is(0.95, swing, STEPS, 1, 0.03);
}

/* A line rising by one a step is decay / (1 - decay) steps ahead of its exponential mean. Taken every eighth step it is
 * (8 d^8) / (1 - d^8) steps: 29.4 instead of 32.3; they differ by less than a stride. */
static void mean_of_a_line_lags_by_its_length(void **state)
{
    (void)state;
    const double decay = 0.97;
    mean_is(decay, line, STEPS, STEPS - decay / (1 - decay), 8);
}

/* A run shorter than the stride has a mean, too: the fifth step updates it with the weight of all five. */
static void the_last_steps_count(void **state)
{
    (void)state;
    mean_is(0.999, nothing, 5, 30 * pow(6.0 / 15, 5), 1e-5);
}

static void swapping_twice_changes_nothing(void **state)
{
    (void)state;
    nn_graph *graph;
    nn_params *params = new_params(&graph);
    train_average *average;
    set_all(params, 2);
    assert_int_equal(train_average_new(params, 0.9, &average), OK);
    set_all(params, 5);
    train_average_swap(average);
    all_equal(params, 2, 0);
    train_average_swap(average);
    all_equal(params, 5, 0);
    train_average_free(average);
    nn_params_free(params);
    nn_graph_free(graph);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mean_is_nearer_to_the_centre_than_any_step),
        cmocka_unit_test(mean_of_a_line_lags_by_its_length),
        cmocka_unit_test(the_last_steps_count),
        cmocka_unit_test(swapping_twice_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
