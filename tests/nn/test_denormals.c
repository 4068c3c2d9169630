/* SPDX-License-Identifier: MIT */
/* Programs run with flush-to-zero, which must not be visible between runs. */
#include <float.h>
#include <string.h>

#include "base/parallel.h"
#include "nn/nn.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { BLOCKS = 4096 };

static void halve_smallest_normal(void *context, size_t begin, size_t end)
{
    volatile float *result = context, smallest = FLT_MIN;
    for (size_t i = begin; i < end; i++)
        result[i] = smallest * 0.5f;
}

static void a_run_leaves_every_threads_arithmetic_as_it_was(void **unused)
{
    (void)unused;
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_input(g, "x", 16, 1);
    nn_output(g, nn_float(g, nn_relu(g, nn_conv2d(g, nn_compute(g, x), "conv", 16, 3, 1, NN_BIAS))), "y");
    nn_params *params;
    nn_program *p;
    nn_options options = {.batch = 2, .height = 32, .width = 32};
    assert_int_equal(nn_params_new(g, 1, &params), OK);
    assert_int_equal(nn_compile(g, params, &options, &p), OK);
    assert_int_equal(nn_forward(p), OK);
    static float result[BLOCKS];
    memset(result, 0, sizeof result);
    parallel_blocks(BLOCKS, halve_smallest_normal, result);
    for (int i = 0; i < BLOCKS; i++)
        assert_true(result[i] > 0);
    nn_program_free(p);
    nn_params_free(params);
    nn_graph_free(g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_run_leaves_every_threads_arithmetic_as_it_was)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
