/* SPDX-License-Identifier: MIT */
/* On a processor without AVX-512 bfloat16 programs compute in float32. This test is a program of its own because oneDNN
 * fixes the instruction set once. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <oneapi/dnnl/dnnl.h>
#include <setjmp.h>

#include "nn/nn.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

static void bfloat16_falls_back_to_float32(void **state)
{
    (void)state;
    if (dnnl_set_max_cpu_isa(dnnl_cpu_isa_avx2) != dnnl_success) skip();
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_compute(g, nn_input(g, "x", 3, 1));
    nn_output(g, nn_relu(g, nn_conv2d(g, x, "conv", 8, 3, 1, NN_BIAS)), "y");
    nn_params *params;
    assert_int_equal(nn_params_new(g, 1, &params), OK);
    nn_options options = {.batch = 1, .height = 8, .width = 8, .type = NN_BFLOAT16};
    nn_program *p, *q;
    assert_int_equal(nn_compile(g, params, &options, &p), OK);
    options.type = NN_FLOAT32;
    assert_int_equal(nn_compile(g, params, &options, &q), OK);
    assert_int_equal(nn_program_type(p), NN_FLOAT32);
    for (int i = 0; i < 8 * 8 * 3; i++)
        nn_input_data(p, "x")[i] = nn_input_data(q, "x")[i] = (float)(i % 17) / 17;
    assert_int_equal(nn_forward(p), OK);
    assert_int_equal(nn_forward(q), OK);
    assert_memory_equal(nn_output_data(p, "y"), nn_output_data(q, "y"), 8 * 8 * 8 * sizeof(float));
    nn_program_free(p);
    nn_program_free(q);
    nn_params_free(params);
    nn_graph_free(g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(bfloat16_falls_back_to_float32)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
